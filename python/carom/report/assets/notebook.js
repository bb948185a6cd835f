// Puts a scene together that stands alone: in the output of a cell of a notebook.
(async () => {
  const data = JSON.parse(document.getElementById("data").textContent);
  Object.assign(carom.format.clockUnit, data.time_unit);
  const arrays = await carom.unpackScene(data.scene);
  const times = arrays.times.array;
  const clock = carom.makeClock(times);
  const maps = carom.colours.textures(data.colour_maps);
  const scene = carom.showScene(data.scene, arrays, maps, clock);
  clock.seek(carom.hardestContact(data, times));
  carom.makeTransport(clock, {
    t: carom.theme.toggle,
    f: () => scene?.fit(),
    "+": () => scene?.zoom(1.2),
    "-": () => scene?.zoom(1 / 1.2),
  });
  document.documentElement.dataset.ready = "true"; // for who waits for the page
})();
