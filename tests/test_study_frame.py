"""What all studies have in common: tasks, rows, and the files that they leave."""

from __future__ import annotations

import csv
import json
from base64 import b64decode
from collections.abc import Iterator
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import pytest
from cogmap.agent import Settings
from cogmap.experiments import workers
from cogmap.experiments.studies import Findings, Study, run_studies, run_study, studies, study_named
from cogmap.model import CogmapError
from command_line import cogmap
from pages import Page
from toy_study import NASTY, Tabled, Toy

NAMES = [
    "buildings",
    "cost",
    "cue",
    "distances",
    "donut",
    "exploration",
    "goals",
    "growth",
    "identity",
    "insight",
    "localisation",
    "martinet",
    "mice",
    "minigrid",
    "rooms",
    "tolman",
]


def saved(folder: Path | str, study: str) -> dict[str, Any]:
    return json.loads(Path(folder, f"{study}.json").read_text())


def table(path: Path) -> list[list[str]]:
    with path.open(newline="") as file:
        return list(csv.reader(file))


# -- rows --------------------------------------------------------------------------------------------------


def test_a_study_runs_with_its_own_settings_unless_told_otherwise() -> None:
    assert [row.seed for row in Toy().rows()] == [0, 1, 2]
    assert [(row.seed, row.look_ahead) for row in Toy().rows(2, seed=5)] == [(5, 9), (6, 9)]
    assert Toy().rows(1, settings=Settings(look_ahead=4))[0].look_ahead == 4


def test_rows_do_not_depend_on_where_they_are_made() -> None:
    done: list[None] = []
    with workers(jobs=2) as executor:
        assert Toy().rows(4, executor=executor, on_done=lambda: done.append(None)) == Toy().rows(4)
    assert len(done) == 4


def test_a_study_that_must_be_alone_is_never_given_an_executor() -> None:
    class Refusing(Executor):
        def submit(self, *args: Any, **kwargs: Any) -> Any:
            pytest.fail("it ran beside something else")

    class Alone(Toy):
        alone = True

    assert len(Alone().rows(2, executor=Refusing())) == 2


@pytest.mark.parametrize(("numbers", "message"), [({"agents": 0}, "agents is 0"), ({"seed": -1}, "seed is -1")])
@pytest.mark.parametrize("name", NAMES)
def test_bad_numbers_are_refused_before_anything_is_run(name: str, numbers: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=f"^{name}: {message}; use . or more$"):
        study_named(name).rows(**numbers)


def test_what_a_protocol_does_no_time_is_refused() -> None:
    with pytest.raises(CogmapError, match="toy: times is 0; use 1 or more"):
        Toy(times=0)


# -- the studies of the package ----------------------------------------------------------------------------


def test_every_study_is_found_and_says_what_it_asks() -> None:
    assert list(studies()) == NAMES
    for name, study in studies().items():
        title, question = study.asks
        assert study_named(name) is study
        assert title
        assert "?" in question
        assert study.notes


def test_unknown_studies_are_refused() -> None:
    with pytest.raises(CogmapError, match=r"no study is called 'x'; choose one of buildings, cost.*, or all"):
        study_named("x")


# -- what is left in a folder ------------------------------------------------------------------------------


def test_what_a_study_leaves_in_its_folder(tmp_path: Path) -> None:
    outcome = run_study(Toy(), tmp_path / "a" / "b", runs=2, seed=7)
    tables = ["toy.csv", "toy_steps.csv", "toy_steps_ways.csv", "toy_summary.csv"]
    pictures = [f"toy_{name}.{suffix}" for name in ("one", "two") for suffix in ("png", "svg")]
    assert [path.name for path in outcome.written] == ["toy.json", *tables, *pictures, "toy.md", "toy.html"]
    assert set(outcome.written) == set((tmp_path / "a" / "b").iterdir())
    assert all(path.stat().st_size for path in outcome.written)
    report = saved(tmp_path / "a" / "b", "toy")
    assert (report["study"], report["agents"], report["seed"]) == ("toy", 2, 7)
    assert (report["settings"]["look_ahead"], report["settings"]["goal_weight"]) == (9, 2.0)
    assert report["rows"][1]["steps"] == [{"x": 0, "ways": []}, {"x": 1, "ways": [{"p": 0.5}]}]
    assert set(report["versions"]) >= {"cogmap", "python", "numpy", "scipy", "platform"}
    assert set(report["machine"]) >= {"processor", "cores", "system", "OMP_NUM_THREADS"}
    assert report["command"] == "run_study(Toy(), folder, runs=2, seed=7)"
    assert (outcome.agents, outcome.lines, len(outcome.failed)) == (2, ["2 rows"], 1)


def test_another_look_ahead_is_in_the_command(tmp_path: Path) -> None:
    run_study(Toy(), tmp_path, runs=1, look_ahead=4)
    assert saved(tmp_path, "toy")["command"].endswith("seed=0, look_ahead=4)")
    run_study(Toy(), tmp_path, runs=1, look_ahead=9)  # its own
    assert saved(tmp_path, "toy")["command"].endswith("seed=0)")
    with pytest.raises(CogmapError, match="look_ahead is 0"):
        run_study(Toy(), tmp_path, look_ahead=0)


def test_every_list_of_rows_is_a_table(tmp_path: Path) -> None:
    run_study(Toy(), tmp_path, runs=2, seed=5)
    rows, steps, ways, summary = (
        table(tmp_path / f"toy{part}.csv") for part in ("", "_steps", "_steps_ways", "_summary")
    )
    assert rows == [
        ["seed", "look_ahead", "at", "choice.route", "choice"],
        ["5", "9", "[5, 2]", "3", ""],
        ["6", "9", "[6, 2]", "", ""],
    ]
    assert steps == [
        ["seed", "step", "x", "ways"],
        ["5", "0", "0", "[]"],
        ["5", "1", "1", ""],
        *[["6", *row] for row in (["0", "0", "[]"], ["1", "1", ""])],
    ]
    assert ways == [["seed", "step", "way", "p"], ["5", "1", "0", "0.5"], ["6", "1", "0", "0.5"]]
    assert summary == [
        ["name", "value"],
        ["agents", "2"],
        ["part.half", "0.5"],
        ["part.yes", "True"],
        [f"part.{NASTY}", NASTY],
    ]


def test_tables_of_its_own_say_what_there_is(tmp_path: Path) -> None:
    run_study(Tabled(), tmp_path, runs=1)
    assert table(tmp_path / "tabled.csv")[1] == [
        "",
        "True",
        "False",
        "3",
        "0.5",
        "12345.6",
        str(1 / 3),
        "x, y",
        '"',
        "two\nlines",
    ]
    markdown = (tmp_path / "tabled.md").read_text()
    assert '| – | yes | no | 3 | 0.5 | 12346 | 0.3333 | x, y | " | two lines |' in markdown
    assert "- `tabled_hidden.csv`: hidden" in markdown
    assert "| c |" not in markdown
    assert "not in the report" not in markdown
    assert "## What failed\n\n- Nothing.\n" in markdown


def test_text_is_shown_as_it_is_and_the_page_needs_nothing_else(tmp_path: Path) -> None:
    run_study(Toy(), tmp_path, runs=2)
    html = (tmp_path / "toy.html").read_text()
    page = Page(html)
    tags = {tag for tag, _ in page.tags}
    assert page.text.count(NASTY) == 6  # title twice, failure, note, and twice in the table
    assert not {"a", "em", "e", "script", "link", "iframe", "object"} & tags
    assert "url(" not in html
    assert "@import" not in html
    pictures = [str(attrs["src"]).split(",") for tag, attrs in page.tags if tag == "img"]
    assert [kind for kind, _ in pictures] == ["data:image/svg+xml;base64"] * 2
    assert b64decode(pictures[0][1]) == (tmp_path / "toy_one.svg").read_bytes()
    assert "Does it do anything?" in page.text
    assert "2 rows" in page.text


def test_figures_that_are_no_numbers_are_refused(tmp_path: Path) -> None:
    class Broken(Toy):
        def summarise(self, rows: Any) -> Findings:
            return Findings({"rows": [], "value": float("nan")}, [], {})

    with pytest.raises(ValueError, match="not JSON compliant"):
        run_study(Broken(), tmp_path, runs=1)


@pytest.mark.parametrize("folder", ["file", "file/below", "n" * 300])
def test_folders_that_could_not_be_written_are_refused_at_once(tmp_path: Path, folder: str) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(CogmapError, match="cannot make folder"):
        run_study(Toy(loud=True), tmp_path / folder)
    (tmp_path / "there" / "toy.json").mkdir(parents=True)
    with pytest.raises(CogmapError, match="it is a folder"):
        run_study(Toy(loud=True), tmp_path / "there")


# -- the command -------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("empty_folder")
def test_a_study_by_name() -> None:
    result = cogmap("study", "donut", "--agents", 1, "--seed", 3, "--look-ahead", 11)
    assert result.exit_code == 0
    assert "1 of 1 agents explored donut" in result.stdout
    assert "written: study-donut/donut.html" in result.stdout
    report = saved("study-donut", "donut")
    assert (report["agents"], report["settings"]["look_ahead"], [row["seed"] for row in report["rows"]]) == (1, 11, [3])
    names = {f"donut.{suffix}" for suffix in ("json", "csv", "md", "html")}
    names |= {"donut_frames.png", "donut_frames.svg", "donut_steps.csv", "donut_steps_paths.csv", "donut_summary.csv"}
    assert {path.name for path in Path("study-donut").iterdir()} == names


def test_the_help_names_every_study() -> None:
    shown = " ".join(cogmap("study", "--help").stdout.split())
    assert all(name in shown for name in NAMES)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "Missing argument"),
        (["nothing"], "no study is called 'nothing'; choose one of buildings"),
        (["donut", "--runs", "0"], "--runs"),
        (["donut", "--agents", "-1"], "--agents"),
        (["donut", "--agents", "many"], "--agents"),
        (["donut", "--seed", "-1"], "--seed"),
        (["donut", "--jobs", "0"], "--jobs"),
        (["growth", "--jobs", "2", "--dask", "localhost:1"], "give one of them"),
        (["all", "--out", "file"], "cannot make folder file"),
        (["all", "--look-ahead", "0"], "--look-ahead"),
        (["donut", "--look-ahead", "0"], "--look-ahead"),
        (["donut", "--out", "file"], "cannot make folder file"),
        (["donut", "--out", "file/below"], "cannot make folder file/below"),
    ],
)
@pytest.mark.usefixtures("empty_folder")
def test_bad_input_is_one_line_and_exit_code_2(arguments: list[str], message: str) -> None:
    Path("file").write_text("")
    result = cogmap("study", *arguments)
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert message in result.stderr
    assert result.stderr.startswith("cogmap: ")
    assert [path.name for path in Path().iterdir()] == ["file"]


# -- all of them -------------------------------------------------------------------------------------------


@pytest.fixture
def three() -> Iterator[dict[str, Study[Any, Any]]]:
    """Three studies in place of those of the package; one fails."""
    mine, others = studies(), dict(studies())
    mine.clear()
    mine |= {"broken": Toy(loud=True), "fine": Tabled(), "toy": Toy()}
    yield mine
    mine.clear()
    mine.update(others)


@pytest.mark.usefixtures("empty_folder", "three")
def test_a_study_that_fails_does_not_stop_the_others() -> None:
    result = cogmap("study", "all", "--runs", 2, "--seed", 4, "--out", "here")
    assert result.exit_code == 1
    assert "toy failed: RuntimeError: out of luck" in result.stdout
    assert {"index.md", "index.html", "index.csv", "tabled"} <= {path.name for path in Path("here").iterdir()}
    markdown = Path("here/index.md").read_text()
    assert "2 of 3 studies were run to their end" in markdown
    assert "- toy: RuntimeError: out of luck" in markdown
    assert "- toy: 1 listed in its report" in markdown  # what did not get there is not nothing
    assert "Nothing." not in markdown
    assert "cogmap study all --runs 2 --seed 4\n" in markdown
    links = [attrs["href"] for tag, attrs in Page(Path("here/index.html").read_text()).tags if tag == "a"]
    assert links == ["tabled/tabled.html", "toy/toy.html"]
    assert all(Path("here", str(link)).is_file() for link in links)
    rows = [row[:2] + row[3:] for row in table(Path("here/index.csv"))]
    assert rows[1:] == [["toy", "2", "failed", "0"], ["tabled", "2", "done", "0"], ["toy", "2", "done", "1"]]


@pytest.mark.usefixtures("empty_folder")
def test_where_nothing_fails_the_exit_code_is_0(three: dict[str, Study[Any, Any]]) -> None:
    del three["broken"], three["toy"]
    result = cogmap("study", "all")
    assert result.exit_code == 0
    assert "written: study-all/index.html" in result.stdout
    assert "- Nothing." in Path("study-all/index.md").read_text()
    assert saved("study-all/tabled", "tabled")["agents"] == 3


@pytest.mark.usefixtures("three")
def test_outcomes_are_told_as_they_come(tmp_path: Path) -> None:
    told: list[str] = []
    outcomes, _ = run_studies(tmp_path, runs=1, on_outcome=lambda one: told.append(one.failure))
    assert [bool(failure) for failure in told] == [True, False, False]
    assert [outcome.agents for outcome in outcomes] == [1, 1, 1]
