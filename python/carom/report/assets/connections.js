// Springs, dampers and point masses, as ribbons and discs that face the camera: lines of WebGL are thin.
carom.makeConnections = (data, arrays, { size, flat }) => {
  const { links, lumps, width } = data;
  const { pieces, drawn, moved, force } = arrays;
  const dimension = drawn.shape[1];
  const count = drawn.shape[0];
  const half = { ink: 0.0013 * size, rim: 0.0032 * size };
  const radius = { ink: 0.008 * size, rim: 0.0105 * size };
  const CORNERS = 20; // of a disc
  const owner = links.flatMap((link, index) => Array(link.pieces).fill(index)); // of every piece
  const places = Array.from({ length: count }, () => new THREE.Vector3());
  const travel = new Float64Array(count * dimension);
  const ends = Array.from({ length: owner.length * 2 }, () => new THREE.Vector3());
  const UPRIGHT = 0.9; // of a direction along z, from which on another axis tells what is across

  // Dark lines with a pale rim are seen on all colours of bodies, and the other way round at night.
  const materials = Object.fromEntries(["ink", "rim", "dot", "ring"].map((name) => [
    name,
    new THREE.MeshBasicMaterial({
      side: THREE.DoubleSide, transparent: true, depthWrite: name === "ink", depthTest: !flat && !["dot", "ring"].includes(name),
    }),
  ]));
  const objects = Object.entries({ rim: owner.length * 6, ink: owner.length * 6, ring: lumps.length * CORNERS * 3, dot: lumps.length * CORNERS * 3 })
    .map(([name, vertices], order) => {
      const geometry = new THREE.BufferGeometry();
      const position = new THREE.BufferAttribute(new Float32Array(vertices * 3), 3);
      geometry.setAttribute("position", position.setUsage(THREE.DynamicDrawUsage));
      const mesh = new THREE.Mesh(geometry, materials[name]);
      mesh.name = name;
      mesh.renderOrder = 1 + 0.1 * order;
      mesh.position.z = flat ? 1.5e-3 * size : 0;
      return mesh;
    });

  // Where everything is in a frame.
  let shown = 0;
  function place(frame, magnification) {
    shown = frame;
    carom.codec.frame(moved, frame, travel);
    places.forEach((point, i) => {
      const at = [0, 1, 2].map((k) => (k < dimension ? drawn.array[i * dimension + k] + magnification * travel[i * dimension + k] : 0));
      point.set(...at);
    });
    const frames = links.map((_, index) => across(places[2 * index], places[2 * index + 1]));
    ends.forEach((point, i) => {
      const { start, along, first, second } = frames[owner[i >> 1]];
      const [s, a, b] = pieces.array.subarray(i * 3, i * 3 + 3);
      point.copy(start).addScaledVector(along, s).addScaledVector(first, width * a).addScaledVector(second, width * b);
    });
  }
  function across(start, end) {
    const along = end.clone().sub(start);
    if (along.length() === 0) return { start, along, first: along, second: along };
    const unit = along.clone().normalize();
    if (flat) return { start, along, first: new THREE.Vector3(-unit.y, unit.x, 0), second: new THREE.Vector3() };
    const helper = Math.abs(unit.z) < UPRIGHT ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
    const first = helper.cross(unit).normalize();
    return { start, along, first, second: unit.clone().cross(first) };
  }

  // Turns ribbons and discs to the camera.
  function draw(camera) {
    const view = camera.getWorldDirection(new THREE.Vector3());
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    const along = new THREE.Vector3();
    const side = new THREE.Vector3();
    for (const { name, geometry } of objects) {
      const { position } = geometry.attributes;
      let vertex = 0;
      const put = (base, a, u, b, v) => position.setXYZ(
        vertex++, base.x + a * u.x + b * v.x, base.y + a * u.y + b * v.y, base.z + a * u.z + b * v.z,
      );
      if (name in half) {
        const h = half[name];
        for (let i = 0; i < owner.length; i++) {
          const [from, to] = [ends[2 * i], ends[2 * i + 1]];
          along.copy(to).sub(from).normalize();
          side.copy(along).cross(view).normalize();
          put(from, -h, along, h, side);
          put(from, -h, along, -h, side);
          put(to, h, along, -h, side);
          put(from, -h, along, h, side);
          put(to, h, along, -h, side);
          put(to, h, along, h, side);
        }
      } else {
        const r = name === "dot" ? radius.ink : radius.rim;
        lumps.forEach((_, index) => {
          const centre = places[2 * links.length + index];
          for (let corner = 0; corner < CORNERS; corner++) {
            const [from, to] = [corner, corner + 1].map((k) => (2 * Math.PI * k) / CORNERS);
            put(centre, 0, right, 0, up);
            put(centre, r * Math.cos(from), right, r * Math.sin(from), up);
            put(centre, r * Math.cos(to), right, r * Math.sin(to), up);
          }
        });
      }
      position.needsUpdate = true;
    }
  }

  function paint(of) {
    materials.ink.color.set(of("ink"));
    materials.dot.color.set(of("ink"));
    materials.rim.color.set(of("shade"));
    materials.ring.color.set(of("shade"));
  }

  // What is at a point of the screen, in words; null if nothing is. `onScreen` takes a place to pixels.
  const NEAR = 9; // pixels
  function at(x, y, onScreen) {
    const points = places.map((point) => onScreen(point));
    const lump = lumps.findIndex((_, index) => {
      const point = points[2 * links.length + index];
      return Math.hypot(point.x - x, point.y - y) <= NEAR;
    });
    if (lump >= 0) return `point mass of ${carom.format.quantity(lumps[lump].mass, "kg", 4)} on ${lumps[lump].of}`;
    const found = links.findIndex((_, index) => distance(x, y, points[2 * index], points[2 * index + 1]) <= NEAR);
    return found < 0 ? null : told(found);
  }
  function distance(x, y, a, b) {
    const [dx, dy] = [b.x - a.x, b.y - a.y];
    const share = ((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy || 1);
    const s = Math.min(1, Math.max(0, share));
    return Math.hypot(a.x + s * dx - x, a.y + s * dy - y);
  }
  function told(index) {
    const { name, kind, between, free_length: free } = links[index];
    const length = trueLength(index);
    const pull = force.array[shown * links.length + index];
    const { quantity } = carom.format;
    const parts = [`length ${quantity(length, "m", 4)}`];
    if (kind === "spring") parts.push(change(length - free));
    if (!Number.isNaN(pull)) parts.push(pull < 0 ? `pushes with ${quantity(-pull, "N", 4)}` : `pulls with ${quantity(pull, "N", 4)}`);
    return `${name} (${between.join(" – ")}): ${parts.join(", ")}`;
  }
  // Displacements on the page are rounded: what is less than that is no change.
  const rounding = 2 * Math.max(...moved.step) + 1e-9 * size;
  function change(by) {
    if (Math.abs(by) <= rounding) return "as long as without tension";
    return `${by < 0 ? "shortened" : "stretched"} by ${carom.format.quantity(Math.abs(by), "m", 3)}`;
  }
  // Of the displacements as they are, however they are magnified.
  function trueLength(index) {
    let sum = 0;
    for (let k = 0; k < dimension; k++) {
      const [a, b] = [2 * index, 2 * index + 1].map((i) => i * dimension + k);
      sum += (drawn.array[b] + travel[b] - drawn.array[a] - travel[a]) ** 2;
    }
    return Math.sqrt(sum);
  }

  return { objects, place, draw, paint, at, show: (wanted) => objects.forEach((mesh) => { mesh.visible = wanted; }) };
};
