// Which step is shown, and how one gets to another.
let now = -1, timer = null;
const root = document.documentElement;

function go(index) {
  index = Math.min(Math.max(index, 0), F.length - 1);
  if (index === now) return;
  now = index;
  const frame = F[index];
  Object.assign(root.dataset, { index: String(index), step: String(frame.step) });
  $("slider").value = index;
  $("slider").setAttribute("aria-valuetext", `step ${frame.step}, ${index + 1} of ${F.length}`);
  $("count").textContent = `${index + 1} / ${F.length}`;
  drawMap(index);
  drawWorld(index);
  drawPixels(frame);
  drawWords(frame);
  drawBelief(frame);
  drawPolicies(frame);
  drawTimes(index);
  drawWindow(index);
}

function play(on) {
  if (timer) clearInterval(timer);
  timer = null;
  if (on && now === F.length - 1) go(0);
  if (on) timer = setInterval(() => (now < F.length - 1 ? go(now + 1) : play(false)), 1000 / Number($("speed").value));
  root.dataset.playing = String(Boolean(on));
  $("play-sign").textContent = on ? "❚❚" : "▶";
  $("play-word").textContent = on ? "Pause" : "Play";
  $("play").setAttribute("aria-label", on ? "Pause" : "Play");
  $("words").setAttribute("aria-live", on ? "off" : "polite"); // nobody can listen to 16 steps a second
}

function step(by) {
  play(false);
  go(now + by);
}

function key(event) {
  if (event.altKey || event.ctrlKey || event.metaKey || event.target.closest("select, .scroll")) return;
  const moves = { ArrowLeft: () => step(-1), ArrowRight: () => step(1), Home: () => step(-F.length), End: () => step(F.length) };
  const act = event.key === " " && !event.target.closest("button, summary") ? () => play(!timer) : moves[event.key];
  if (!act) return;
  event.preventDefault();
  act();
}

function theme(dark) {
  root.dataset.theme = dark ? "dark" : "light";
  $("theme").setAttribute("aria-pressed", String(dark));
}

function begin() {
  $("title").textContent = R.title || "cogmap replay";
  $("slider").max = F.length - 1;
  const wanted = matchMedia("(prefers-color-scheme: dark)");
  theme(wanted.matches);
  wanted.addEventListener("change", (event) => theme(event.matches));
  $("theme").addEventListener("click", () => theme(root.dataset.theme !== "dark"));
  $("first").addEventListener("click", () => step(-F.length));
  $("back").addEventListener("click", () => step(-1));
  $("forth").addEventListener("click", () => step(1));
  $("last").addEventListener("click", () => step(F.length));
  $("play").addEventListener("click", () => play(!timer));
  $("speed").addEventListener("change", () => timer && play(true));
  $("slider").addEventListener("input", () => { play(false); go(Number($("slider").value)); });
  document.addEventListener("keydown", key);
  measureMaps();
  readWindows();
  prepareWorld();
  preparePixels();
  prepareMap();
  preparePolicies();
  layTimes();
  layWindow();
  measureMap();
  root.dataset.playing = "false";
  go(0);
  let width = root.clientWidth;
  addEventListener("resize", () => {
    if (root.clientWidth === width) return;
    width = root.clientWidth;
    layTimes();
    layWindow();
    measureMap();
    drawMap(now);
    drawTimes(now);
    drawWindow(now);
  });
}

begin();
