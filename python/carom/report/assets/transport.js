// Playing and stepping through time, by buttons, slider and keys.
carom.makeTransport = (clock, actions) => {
  const at = (id) => document.getElementById(id);
    const scrub = at("scrub");
  scrub.max = String(clock.last);
  const digits = Math.min(12, Math.max(4, Math.ceil(Math.log10(clock.last + 1)) + 2));

  const buttons = {
    first: () => move(() => clock.goTo(0)),
    back: () => move(() => clock.step(-1)),
    play: () => clock.toggle(),
    forward: () => move(() => clock.step(1)),
    last: () => move(() => clock.goTo(clock.last)),
  };
  function move(action) {
    clock.pause();
    action();
  }
  for (const [id, action] of Object.entries(buttons)) at(id).addEventListener("click", action);
  scrub.addEventListener("input", () => {
    const wanted = Number(scrub.value); // before the pause puts the slider back
    move(() => clock.goTo(wanted));
  });
  at("speed").addEventListener("change", (event) => clock.setSpeed(Number(event.target.value)));

  const keys = {
    " ": () => clock.toggle(),
    ArrowLeft: (event) => move(() => clock.step(event.shiftKey ? -10 : -1)),
    ArrowRight: (event) => move(() => clock.step(event.shiftKey ? 10 : 1)),
    Home: () => move(() => clock.goTo(0)),
    End: () => move(() => clock.goTo(clock.last)),
    ...actions,
  };
  document.addEventListener("keydown", (event) => {
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    if (target.matches("select, textarea, input:not([type=range], [type=checkbox])")) return;
    if (event.key === " " && target.matches("button, summary, a, input[type=checkbox]")) return;
    if (event.key.length > 1 && target.closest(".scroll, pre")) return;
    event.preventDefault();
    action(event);
  });

  function tell() {
    scrub.value = String(clock.index);
    const time = carom.format.time(clock.time, digits);
    at("time").textContent = `t = ${time} · ${clock.index + 1}/${clock.last + 1}`;
    scrub.setAttribute("aria-valuetext", `t = ${time}`);
    at("play").setAttribute("aria-pressed", String(clock.playing));
    at("play").setAttribute("aria-label", clock.playing ? "Pause" : "Play");
    at("pace").textContent = `${carom.format.time(clock.pace(), 3)} a second`;
  }
  clock.onChange(tell);
  at("transport").hidden = false;
  tell();
};
