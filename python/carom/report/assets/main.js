// Puts the page together from the data in it.
(async () => {
  const at = (id) => document.getElementById(id);
  const { quantity, options } = carom.format;
  const data = JSON.parse(at("data").textContent);
  Object.assign(carom.format.clockUnit, data.time_unit);

  async function unpackAll(packed) {
    const entries = Object.entries(packed).map(async ([name, array]) => [name, await carom.codec.unpack(array)]);
    return Object.fromEntries(await Promise.all(entries));
  }

  const columns = Object.fromEntries(
    Object.entries(await unpackAll(data.curves.columns)).map(([name, { array }]) => [name, array]),
  );
  const arrays = data.scene && (await unpackScene(data.scene));
  const times = arrays ? arrays.times.array : columns.time;

  async function unpackScene(scene) {
    for (const obstacle of scene.obstacles.filter(({ kind }) => kind === "surface")) {
      obstacle.points = await carom.codec.unpack(obstacle.points);
      obstacle.triangles = await carom.codec.unpack(obstacle.triangles);
    }
    const { points, triangles, face, body, edges, rim, times: stamps } = scene;
    return unpackAll({ points, triangles, face, body, edges, rim, times: stamps, ...scene.arrays });
  }

  // The page opens at what is most worth seeing.
  function hardestContact() {
    const hardest = data.contacts.reduce((a, b) => (b.peak_force > (a?.peak_force ?? 0) ? b : a), null);
    return hardest ? (hardest.onset + (hardest.release ?? data.end)) / 2 : times[0];
  }

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
    const scene = arrays ? showScene(maps) : null;
    const picture = scene && carom.makePicture(scene, maps, clock);
    const charts = showCurves();
    if (picture) offerPictures(picture);
    carom.makePrinting(picture, () => charts?.all() ?? []);
    clock.seek(hardestContact());
    carom.makeTransport(clock, {
      t: carom.theme.toggle,
      f: () => scene?.fit(),
      "+": () => scene?.zoom(1.2),
      "-": () => scene?.zoom(1 / 1.2),
    });
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

  function sayWhyNoScene() {
    const text = "The scene needs WebGL 2, which this browser does not offer: turn on its graphics acceleration, or take another. "
      + "Curves and numbers work without; carom picture draws the bodies.";
    const stage = at("stage");
    stage.append(carom.format.create("p", { className: "nothing", textContent: text }));
    for (const name of ["role", "aria-label", "tabindex"]) stage.removeAttribute(name); // it is text, and no picture
    for (const part of at("scene").children) part.hidden = part !== stage;
  }

  function showScene(maps) {
    at("scene").hidden = false;
    if (!document.createElement("canvas").getContext("webgl2")) {
      sayWhyNoScene();
      return null;
    }
    const scene = carom.makeScene(data.scene, arrays, maps);
    const { fields, bodies } = data.scene;
    const isScalar = (field) => field && field.unit !== undefined;
    const nameOf = (body) => bodies[body] ?? `body ${body + 1}`;
    options(at("field"), fields.map(({ title }, index) => [index, title]));
    at("forces").disabled = !scene.hasForces;
    at("forces").checked = scene.hasForces;

    const listen = (id, changes) => at(id).addEventListener("change", (event) => scene.set(changes(event.target)));
    listen("field", ({ value }) => ({ field: fields[value] }));
    listen("range", ({ value }) => ({ range: value }));
    listen("edges", ({ checked }) => ({ edges: checked }));
    listen("forces", ({ checked }) => ({ forces: checked }));
    at("magnification").addEventListener("input", ({ target }) => {
      if (target.value !== "" && target.checkValidity()) scene.set({ magnification: Number(target.value) });
    });
    at("fit").addEventListener("click", scene.fit);

    let pointer = null;
    function read() {
      const { field } = scene.state;
      const found = pointer && scene.probe(pointer);
      if (found) {
        const value = found.value === null ? "" : `${field.title} ${quantity(found.value, field.unit, 4)}, `;
        const place = found.at.toArray().slice(0, data.scene.dimension).map((x) => carom.format.number(x, 4));
        at("readout").textContent = `${nameOf(found.body)}: ${value}at (${place.join(", ")}) m`;
      } else if (isScalar(field)) {
        const { low, high } = carom.colours.range(scene.values(), false);
        at("readout").textContent = `${field.title} in this frame up to ${quantity(high, field.unit, 4)}`
          + (low < 0 ? `, down to ${quantity(low, field.unit, 4)}` : "");
      }
    }
    scene.canvas.addEventListener("pointermove", (event) => {
      pointer = event.buttons ? null : event;
      requestAnimationFrame(read);
    });
    scene.canvas.addEventListener("pointerleave", () => {
      pointer = null;
      read();
    });
    scene.onChange(() => {
      carom.colourBar.show(scene.state.field, scene.limits(), maps[scene.state.field.map]);
      read();
      at("stage").setAttribute("aria-label", `Deformed bodies at t = ${carom.format.time(clock.time, 5)}`);
      at("stage").dataset.frame = String(scene.state.frame);
    });
    clock.onChange(() => {
      if (clock.index !== scene.state.frame) scene.set({ frame: clock.index });
    });
    scene.start();
    scene.set({ field: fields[0] });
    return scene;
  }
})();
