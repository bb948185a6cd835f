// Puts the page together from the data in it.
(async () => {
  const at = (id) => document.getElementById(id);
  const data = JSON.parse(at("data").textContent);
  Object.assign(carom.format.clockUnit, data.time_unit);

  const columns = Object.fromEntries(
    Object.entries(await carom.unpackAll(data.curves.columns)).map(([name, { array }]) => [name, array]),
  );
  const arrays = data.scene && (await carom.unpackScene(data.scene));
  const times = arrays ? arrays.times.array : columns.time;

  function widestName(contacts) {
    const context = document.createElement("canvas").getContext("2d");
    context.font = "13px system-ui, sans-serif";
    const widths = contacts.map(({ pair }) => context.measureText(pair.join(" – ")).width);
    const most = matchMedia("(max-width: 760px)").matches ? 84 : 118;
    return Math.min(most, 8 + Math.max(58, ...widths));
  }

  const clock = times && times.length ? carom.makeClock(times) : null;
  if (clock) {
    const maps = carom.colours.textures(data.colour_maps);
    const scene = arrays ? carom.showScene(data.scene, arrays, maps, clock) : null;
    const picture = scene && carom.makePicture(scene, maps, clock);
    const charts = showCurves();
    if (picture) offerPictures(picture);
    carom.makePrinting(picture, () => charts?.all() ?? []);
    clock.seek(carom.hardestContact(data, times));
    carom.makeTransport(clock, {
      t: carom.theme.toggle,
      f: () => scene?.fit(),
      "+": () => scene?.zoom(1.2),
      "-": () => scene?.zoom(1 / 1.2),
    });
    carom.makeSpectrograms(clock);
    for (const button of document.querySelectorAll(".go")) {
      button.addEventListener("click", () => {
        clock.pause();
        clock.seek(Number(button.dataset.time));
        at("transport").previousElementSibling.scrollIntoView({ block: "nearest" });
      });
    }
  }
  carom.save.offerTables();
  document.documentElement.dataset.ready = "true"; // for who waits for the page

  function showCurves() {
    const { panels } = data.curves;
    if (!panels.length) return null;
    at("curves").hidden = false;
    const gutter = widestName(data.contacts);
    const charts = carom.makeCharts(clock, gutter);
    const stamps = Array.from(columns.time);
    for (const panel of panels) {
      const curves = panel.curves.map((curve) => ({ ...curve, values: columns[curve.column] }));
      charts.add(at("panels"), { ...panel, curves, times: stamps });
      if (panel.id === "energy" && data.contacts.length) {
        carom.makeTimeline(at("panels"), data.contacts, data.end, clock, charts, gutter);
      }
    }
    carom.makeExplorer(data.curves, columns, charts);
    return charts;
  }

  function offerPictures(picture) {
    const film = carom.makeFilm(picture, clock);
    const { button } = carom.save;
    const at5 = () => `t=${carom.format.inUnit(clock.time, 5)}${data.time_unit.symbol}`;
    at("fit").before(button("PNG", "Save the scene as PNG", () => carom.save.picture(picture.draw(undefined, large()), at5())));
    // For papers and slides, of the shape that the reader sees.
    function large() {
      const { clientWidth, clientHeight } = at("stage");
      return { width: 1920, height: Math.round((1920 * clientHeight) / clientWidth) };
    }
    if (film.canRecord) {
      at("fit").before(button("Film", "Save a film: the run plays once, at the speed chosen below", film.record));
    }
  }
})();
