// The bodies in colours, the obstacles, and the camera.
carom.makeScene = (data, arrays, maps) => {
  const stage = document.getElementById("stage");
  const flat = data.dimension === 2;
  const count = arrays.points.shape[0];
  const triangleCount = arrays.triangles.shape[0];
  const box = boxOf(data.low, data.high);
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
  const scene = new THREE.Scene();
  const camera = flat ? new THREE.OrthographicCamera() : new THREE.PerspectiveCamera(35);
  if (!flat) camera.up.set(0, 0, 1);
  stage.append(renderer.domElement);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.enableRotate = !flat;
  controls.screenSpacePanning = true;
  if (flat) {
    controls.mouseButtons.LEFT = 2; // pan
    controls.touches.ONE = 1;
  }
  const state = { frame: 0, magnification: 1, field: null, range: "run", edges: true, forces: true, attached: true };

  function boxOf(low, high) {
    const extent = [0, 1, 2].map((k) => (high[k] ?? 0) - (low[k] ?? 0));
    const size = Math.hypot(...extent) || 1;
    const centre = new THREE.Vector3(...[0, 1, 2].map((k) => ((high[k] ?? 0) + (low[k] ?? 0)) / 2));
    return { extent, size, centre };
  }

  // --- what is drawn -----------------------------------------------------------------------------
  const places = new Float32Array(count * 3);
  const travel = new Float64Array(count * data.dimension);
  const texture = maps.sequential.texture;
  const faceMaterial = flat
    ? new THREE.MeshBasicMaterial({ map: texture, side: THREE.DoubleSide })
    : new THREE.MeshLambertMaterial({ map: texture, side: THREE.DoubleSide, flatShading: true });
  Object.assign(faceMaterial, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  const ribbonMaterial = new THREE.MeshBasicMaterial({ map: texture, side: THREE.DoubleSide });
  const edgeMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.28 });
  const rimMaterial = new THREE.LineBasicMaterial();
  const arrowMaterial = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, depthTest: false });
  const solid = {
    fill: new THREE.MeshBasicMaterial(),
    line: new THREE.LineBasicMaterial({ transparent: !flat, opacity: flat ? 1 : 0.45 }),
    wall: translucent(THREE.MeshBasicMaterial, THREE.DoubleSide, 0.55),
    outside: translucent(THREE.MeshLambertMaterial, THREE.FrontSide, 0.6),
    inside: translucent(THREE.MeshLambertMaterial, THREE.BackSide, 0.6),
  };
  function translucent(Material, side, opacity) {
    return new Material({ transparent: true, opacity, depthWrite: false, side });
  }

  function buffer(vertices, withColours) {
    const geometry = new THREE.BufferGeometry();
    const add = (name, size) => {
      const attribute = new THREE.BufferAttribute(new Float32Array(vertices * size), size);
      geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
    };
    add("position", 3);
    if (withColours) add("uv", 2);
    return geometry;
  }
  const faces = new THREE.Mesh(buffer(triangleCount * 3, true), faceMaterial);
  const edges = new THREE.LineSegments(buffer(arrays.edges.array.length, false), edgeMaterial);
  const rim = new THREE.LineSegments(buffer(arrays.rim.array.length, false), rimMaterial);
  const ribbon = new THREE.Mesh(buffer(arrays.rim.array.length * 3, true), ribbonMaterial);
  const arrows = new THREE.Mesh(buffer(0, false), arrowMaterial);
  edges.position.z = rim.position.z = ribbon.position.z = flat ? 1e-3 * box.size : 0;
  arrows.position.z = flat ? 2e-3 * box.size : 0;
  arrows.renderOrder = 2;
  const obstacles = data.obstacles.map((obstacle) => carom.shapes.make(obstacle, box, data.dimension, solid));
  const connections = data.connections && carom.makeConnections(data.connections, arrays.connections, { size: box.size, flat });
  for (const mesh of [faces, edges, rim, ribbon, arrows, ...obstacles, ...(connections?.objects ?? [])]) {
    mesh.frustumCulled = false;
    scene.add(mesh);
  }
  const lamp = new THREE.DirectionalLight(0xffffff, 1.6);
  scene.add(new THREE.HemisphereLight(0xffffff, 0xc8ced8, 2.5), lamp, lamp.target);

  // --- values ------------------------------------------------------------------------------------
  function valuesAt(frame) {
    const packed = arrays[state.field.key];
    const [, rows, components] = packed.shape;
    const all = carom.codec.frame(packed, frame, new Float64Array(rows * components));
    return components === 1 ? all : lengths(all, components);
  }
  function lengths(vectors, components) {
    const sizes = new Float64Array(vectors.length / components);
    for (let i = 0; i < sizes.length; i++) {
      let sum = 0;
      for (let k = 0; k < components; k++) sum += vectors[i * components + k] ** 2;
      sizes[i] = Math.sqrt(sum);
    }
    return sizes;
  }
  const isSigned = () => state.field.map === "diverging";
  const wholeRun = new Map();
  function range() {
    if (state.range === "frame") return carom.colours.range(valuesAt(state.frame), isSigned());
    const { key } = state.field;
    if (!wholeRun.has(key)) {
      const ends = [];
      for (let frame = 0; frame < arrays[key].shape[0]; frame++) {
        let low = Infinity;
        let high = -Infinity;
        for (const value of valuesAt(frame)) {
          if (value < low) low = value;
          if (value > high) high = value;
        }
        if (low <= high) ends.push(low, high);
      }
      wholeRun.set(key, carom.colours.range(ends, isSigned()));
    }
    return wholeRun.get(key);
  }

  // --- a frame -----------------------------------------------------------------------------------
  function place() {
    carom.codec.frame(arrays.displacement, state.frame, travel);
    const { dimension } = data;
    for (let i = 0; i < count; i++) {
      for (let k = 0; k < dimension; k++) {
        const u = travel[i * dimension + k];
        places[i * 3 + k] = arrays.points.array[i * dimension + k] + state.magnification * (Number.isNaN(u) ? 0 : u);
      }
    }
  }
  function take(geometry, indices) {
    const { array } = geometry.attributes.position;
    for (let i = 0; i < indices.length; i++) {
      const point = indices[i] * 3;
      array[i * 3] = places[point];
      array[i * 3 + 1] = places[point + 1];
      array[i * 3 + 2] = places[point + 2];
    }
    geometry.attributes.position.needsUpdate = true;
  }
  let values = null;
  let limits = null;
  function colour() {
    values = valuesAt(state.frame);
    limits = range();
    const map = maps[state.field.map].texture;
    const onRim = state.field.place === "rim";
    if (faceMaterial.map !== (onRim ? null : map)) {
      faceMaterial.map = onRim ? null : map;
      faceMaterial.needsUpdate = true;
    }
    faceMaterial.color.set(onRim ? carom.theme.colour("solid") : "#ffffff");
    ribbonMaterial.map = map;
    ribbon.visible = onRim;
    rim.visible = flat && !onRim;
    if (onRim) {
      colourRibbon();
      return;
    }
    const { array } = faces.geometry.attributes.uv;
    const onPoints = state.field.place === "points";
    const triangles = arrays.triangles.array;
    for (let t = 0; t < triangleCount; t++) {
      for (let corner = 0; corner < 3; corner++) {
        const row = onPoints ? triangles[t * 3 + corner] : arrays.face.array[t];
        const vertex = (t * 3 + corner) * 2;
        array[vertex] = carom.colours.place(values[row], limits);
        array[vertex + 1] = 0.5;
      }
    }
    faces.geometry.attributes.uv.needsUpdate = true;
  }
  // In the plane what happens on the boundary is a band along it.
  function colourRibbon() {
    const { position, uv } = ribbon.geometry.attributes;
    const ends = arrays.rim.array;
    const half = 0.006 * box.size;
    for (let i = 0; i < ends.length / 2; i++) {
      const a = ends[i * 2] * 3;
      const b = ends[i * 2 + 1] * 3;
      const [dx, dy] = [places[b] - places[a], places[b + 1] - places[a + 1]];
      const scale = half / (Math.hypot(dx, dy) || 1);
      const [nx, ny] = [-dy * scale, dx * scale];
      const corners = [[a, 1], [b, 1], [b, -1], [a, 1], [b, -1], [a, -1]];
      corners.forEach(([point, side], k) => {
        const vertex = i * 6 + k;
        position.array[vertex * 3] = places[point] + side * nx;
        position.array[vertex * 3 + 1] = places[point + 1] + side * ny;
        uv.array[vertex * 2] = carom.colours.place(values[i], limits);
        uv.array[vertex * 2 + 1] = 0.5;
      });
    }
    position.needsUpdate = uv.needsUpdate = true;
  }

  // --- forces ------------------------------------------------------------------------------------
  const reactions = arrays.reaction && arrays.reaction.step.some((step) => step > 0) ? arrays.reaction : null;
  const reaction = reactions && new Float64Array(count * data.dimension);
  let strongest = 0;
  if (reactions) {
    for (let frame = 0; frame < reactions.shape[0]; frame++) {
      for (const size of lengths(carom.codec.frame(reactions, frame, reaction), data.dimension)) {
        if (size > strongest) strongest = size;
      }
    }
  }
  function drawArrows() {
    arrows.visible = Boolean(reactions && state.forces);
    if (!arrows.visible) return;
    carom.codec.frame(reactions, state.frame, reaction);
    const sizes = lengths(reaction, data.dimension);
    // Rounding must not draw forces where there are none.
    const least = 2 * Math.max(...reactions.step);
    const acting = [...sizes.keys()].filter((i) => sizes[i] > Math.max(least, 2e-3 * strongest));
    if (arrows.geometry.attributes.position.count < acting.length * 9) {
      arrows.geometry.dispose();
      arrows.geometry = buffer(acting.length * 18, false);
    }
    const { position } = arrows.geometry.attributes;
    const view = camera.getWorldDirection(new THREE.Vector3());
    let vertex = 0;
    const put = (...points) => {
      for (const point of points) point.toArray(position.array, 3 * vertex++);
    };
    for (const i of acting) {
      const from = new THREE.Vector3().fromArray(places, i * 3);
      const along = new THREE.Vector3(
        ...[0, 1, 2].map((k) => (k < data.dimension ? reaction[i * data.dimension + k] : 0)),
      ).multiplyScalar((0.16 * box.size) / strongest);
      const length = along.length();
      const across = along.clone().cross(view).normalize();
      const tip = from.clone().add(along);
      const head = Math.min(0.4 * length, 0.018 * box.size);
      const neck = tip.clone().addScaledVector(along, -head / length);
      const at = (base, width) => base.clone().addScaledVector(across, width);
      const thin = 0.11 * head;
      put(at(from, thin), at(from, -thin), at(neck, -thin), at(from, thin), at(neck, -thin), at(neck, thin));
      put(at(neck, 0.42 * head), at(neck, -0.42 * head), tip);
    }
    arrows.geometry.setDrawRange(0, vertex);
    position.needsUpdate = true;
  }

  // --- drawing -----------------------------------------------------------------------------------
  let asked = false;
  function ask() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      draw();
    });
  }
  function draw() {
    lamp.position.copy(camera.position);
    lamp.target.position.copy(controls.target);
    for (const obstacle of obstacles) {
      const { wall } = obstacle.userData;
      if (wall) {
        obstacle.visible = camera.position.clone().sub(wall.foot).sub(obstacle.position).dot(wall.normal) > 0;
      }
    }
    drawArrows();
    if (state.attached) connections?.draw(camera);
    renderer.render(scene, camera);
  }
  const listeners = [];
  function update() {
    place();
    take(faces.geometry, arrays.triangles.array);
    take(edges.geometry, arrays.edges.array);
    take(rim.geometry, arrays.rim.array);
    colour();
    faces.geometry.boundingSphere = null;
    obstacles.forEach((obstacle) => {
      const [x, y, z = 0] = obstacle.userData.travel[state.frame];
      obstacle.position.set(x, y, z).multiplyScalar(state.magnification);
    });
    edges.visible = state.edges;
    connections?.place(state.frame, state.magnification);
    connections?.show(state.attached);
    for (const listener of listeners) listener();
    ask();
  }
  function fit() {
    const { clientWidth: width, clientHeight: height } = stage;
    const aspect = width / Math.max(height, 1);
    controls.target.copy(box.centre);
    camera.zoom = 1;
    if (flat) {
      camera.position.copy(box.centre).setZ(box.size);
    } else {
      const angle = (camera.fov * Math.PI) / 360;
      const distance = (0.5 * box.size) / Math.sin(Math.atan(Math.tan(angle) * Math.min(1, aspect)));
      camera.position.copy(box.centre).addScaledVector(new THREE.Vector3(1, -1.6, 0.7).normalize(), distance);
    }
    resize();
    controls.update();
  }
  function resize() {
    sizeTo(stage.clientWidth, stage.clientHeight, Math.min(devicePixelRatio, 2));
    ask();
  }
  function sizeTo(width, height, ratio) {
    if (!width || !height) return;
    const aspect = width / height;
    renderer.setPixelRatio(ratio);
    renderer.setSize(width, height, false);
    if (flat) {
      const half = 0.54 * Math.max(box.extent[1], box.extent[0] / aspect, 1e-3 * box.size);
      Object.assign(camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
      Object.assign(camera, { near: 0, far: 4 * box.size });
    } else {
      Object.assign(camera, { aspect, near: 1e-3 * box.size, far: 60 * box.size });
    }
    camera.updateProjectionMatrix();
  }
  // The scene as it stands on a canvas that keeps its pixels: WebGL forgets its own once they are shown.
  function shot(size) {
    if (size) sizeTo(size.width, size.height, 1);
    draw();
    const { width, height } = renderer.domElement;
    const copy = carom.format.create("canvas", { width, height });
    copy.getContext("2d").drawImage(renderer.domElement, 0, 0);
    if (size) {
      resize();
      draw();
    }
    return copy;
  }
  function paint() {
    const { colour: of } = carom.theme;
    edgeMaterial.color.set(of("body-line"));
    rimMaterial.color.set(of("body-line"));
    arrowMaterial.color.set(of("mark"));
    for (const name of ["fill", "wall", "outside", "inside"]) solid[name].color.set(of("solid"));
    solid.line.color.set(of("solid-line"));
    connections?.paint(of);
    if (state.field) colour();
    ask();
  }

  // What is under the pointer: a spring or a mass, or else the body, and the value there.
  const caster = new THREE.Raycaster();
  function probe(event) {
    const area = renderer.domElement.getBoundingClientRect();
    const x = (2 * (event.clientX - area.left)) / area.width - 1;
    const y = 1 - (2 * (event.clientY - area.top)) / area.height;
    const onScreen = (point) => {
      const { x: across, y: up } = point.clone().project(camera);
      return { x: (0.5 + across / 2) * area.width, y: (0.5 - up / 2) * area.height };
    };
    const attached = state.attached && connections?.at(event.clientX - area.left, event.clientY - area.top, onScreen);
    if (attached) return { attached };
    caster.setFromCamera(new THREE.Vector2(x, y), camera);
    const [hit] = caster.intersectObject(faces);
    if (!hit) return null;
    const face = arrays.face.array[hit.faceIndex];
    const corners = [0, 1, 2].map((k) => arrays.triangles.array[hit.faceIndex * 3 + k]);
    const near = corners.reduce((best, point) => (away(point, hit.point) < away(best, hit.point) ? point : best));
    const row = { points: near, faces: face }[state.field.place];
    return { body: arrays.body.array[face], at: hit.point, value: row === undefined ? null : values[row] };
  }
  const away = (point, from) => new THREE.Vector3().fromArray(places, point * 3).distanceToSquared(from);

  controls.addEventListener("change", ask);
  new ResizeObserver(resize).observe(stage);
  carom.theme.onChange(paint);

  return {
    state,
    set(changes) {
      Object.assign(state, changes);
      update();
    },
    start() {
      fit();
      paint();
    },
    fit,
    shot,
    zoom(factor) {
      camera.zoom *= factor;
      camera.updateProjectionMatrix();
      ask();
    },
    probe,
    limits: () => limits,
    values: () => values,
    hasForces: Boolean(reactions),
    canvas: renderer.domElement,
    onChange: (listener) => listeners.push(listener),
  };
};
