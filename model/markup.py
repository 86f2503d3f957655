"""Text that is safe within HTML and SVG, whatever it holds."""

import html
import re
from collections.abc import Sequence

_NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def safe(text: object) -> str:
    """The text with markup escaped, and characters that XML does not have replaced."""
    return html.escape(_NOT_XML.sub("\ufffd", str(text)))


def html_table(headings: Sequence[object], rows: Sequence[Sequence[object]], *, most: int, caption: str = "") -> str:
    """An HTML table of the first `most` rows, and how many more there are."""
    head = "".join(f"<th>{safe(heading)}</th>" for heading in headings)
    body = "".join(f"<tr>{''.join(f'<td>{safe(cell)}</td>' for cell in row)}</tr>" for row in rows[:most])
    more = f'<tr><td colspan="{len(headings)}">… {len(rows) - most} more</td></tr>' if len(rows) > most else ""
    title = f"<caption>{safe(caption)}</caption>" if caption else ""
    return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}{more}</tbody></table>"
