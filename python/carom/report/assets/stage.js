// The bodies of a run with the tools around them: on the page of a report, and alone in a notebook.
carom.unpackAll = async (packed) => {
  const entries = Object.entries(packed).map(async ([name, array]) => [name, await carom.codec.unpack(array)]);
  return Object.fromEntries(await Promise.all(entries));
};

carom.unpackScene = async (scene) => {
  for (const obstacle of scene.obstacles.filter(({ kind }) => kind === "surface")) {
    obstacle.points = await carom.codec.unpack(obstacle.points);
    obstacle.triangles = await carom.codec.unpack(obstacle.triangles);
  }
  const { points, triangles, face, body, edges, rim, times } = scene;
  const arrays = await carom.unpackAll({ points, triangles, face, body, edges, rim, times, ...scene.arrays });
  return { ...arrays, connections: scene.connections && (await carom.unpackAll(scene.connections.arrays)) };
};

// The time that is most worth seeing: the middle of the hardest contact.
carom.hardestContact = ({ contacts, end }, times) => {
  const hardest = contacts.reduce((a, b) => (b.peak_force > (a?.peak_force ?? 0) ? b : a), null);
  return hardest ? (hardest.onset + (hardest.release ?? end)) / 2 : times[0];
};

carom.showScene = (() => {
  const at = (id) => document.getElementById(id);
  const { quantity, options } = carom.format;

  function sayWhyNoScene() {
    const text = "The scene needs WebGL 2, which this browser does not offer: turn on its graphics acceleration, or take another. "
      + "Curves and numbers work without; carom picture draws the bodies.";
    const stage = at("stage");
    stage.append(carom.format.create("p", { className: "nothing", textContent: text }));
    for (const name of ["role", "aria-label", "tabindex"]) stage.removeAttribute(name); // it is text, and no picture
    for (const part of at("scene").children) part.hidden = part !== stage;
  }

  return (data, arrays, maps, clock) => {
    at("scene").hidden = false;
    if (!document.createElement("canvas").getContext("webgl2")) {
      sayWhyNoScene();
      return null;
    }
    const scene = carom.makeScene(data, arrays, maps);
    const { fields, bodies } = data;
    const isScalar = (field) => field && field.unit !== undefined;
    const nameOf = (body) => bodies[body] ?? `body ${body + 1}`;
    options(at("field"), fields.map(({ title }, index) => [index, title]));
    at("forces").disabled = !scene.hasForces;
    at("forces").checked = scene.hasForces;
    at("attached-choice").hidden = !data.connections;

    const listen = (id, changes) => at(id).addEventListener("change", (event) => scene.set(changes(event.target)));
    listen("field", ({ value }) => ({ field: fields[value] }));
    listen("range", ({ value }) => ({ range: value }));
    listen("edges", ({ checked }) => ({ edges: checked }));
    listen("forces", ({ checked }) => ({ forces: checked }));
    listen("attached", ({ checked }) => ({ attached: checked }));
    at("magnification").addEventListener("input", ({ target }) => {
      if (target.value !== "" && target.checkValidity()) scene.set({ magnification: Number(target.value) });
    });
    at("fit").addEventListener("click", scene.fit);

    let pointer = null;
    function read() {
      const { field } = scene.state;
      const found = pointer && scene.probe(pointer);
      if (found?.attached) {
        at("readout").textContent = found.attached;
      } else if (found) {
        const value = found.value === null ? "" : `${field.title} ${quantity(found.value, field.unit, 4)}, `;
        const place = found.at.toArray().slice(0, data.dimension).map((x) => carom.format.number(x, 4));
        at("readout").textContent = `${nameOf(found.body)}: ${value}at (${place.join(", ")}) m`;
      } else if (isScalar(field)) {
        const { low, high } = carom.colours.extremes(scene.values());
        at("readout").textContent = low > high ? "" : `${field.title} in this frame up to ${quantity(high, field.unit, 4)}`
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
  };
})();
