// Rigid obstacles as groups for the scene.
carom.shapes = (() => {
  const SEGMENTS = 512; // of a circle
  const spatial = (v) => new THREE.Vector3(v[0], v[1], v[2] ?? 0);

  function make(obstacle, box, dimension, materials) {
    const group = dimension === 2 ? inPlane(obstacle, box, materials) : inSpace(obstacle, box, materials);
    group.userData.travel = obstacle.travel;
    return group;
  }

  function outline(geometry, material) {
    // Ends of an outline: every point and the next, around.
    const count = geometry.length;
    const points = new Float32Array(count * 6);
    geometry.forEach((point, i) => {
      point.toArray(points, i * 6);
      geometry[(i + 1) % count].toArray(points, i * 6 + 3);
    });
    return lines(points, material);
  }
  function lines(points, material) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    return new THREE.LineSegments(geometry, material);
  }
  function circle(centre, radius) {
    return Array.from({ length: SEGMENTS }, (_, i) => {
      const angle = (2 * Math.PI * i) / SEGMENTS;
      return new THREE.Vector3(centre.x + radius * Math.cos(angle), centre.y + radius * Math.sin(angle), 0);
    });
  }

  // In the plane: what is solid is filled. Lines lie below all fills, or those of walls that cross
  // would run on inside the other wall.
  function inPlane(obstacle, box, { fill, line }) {
    const group = new THREE.Group();
    const size = 40 * box.size;
    let solid;
    let edge;
    if (obstacle.kind === "plane") {
      const normal = spatial(obstacle.normal).normalize();
      const along = new THREE.Vector3(-normal.y, normal.x, 0);
      const foot = footOn(spatial(obstacle.point), normal, box.centre);
      solid = new THREE.Mesh(new THREE.PlaneGeometry(size, size / 2), fill);
      solid.position.copy(foot).addScaledVector(normal, -size / 4);
      solid.rotation.z = Math.atan2(along.y, along.x);
      const a = foot.clone().addScaledVector(along, size / 2);
      const b = foot.clone().addScaledVector(along, -size / 2);
      edge = lines(new Float32Array([...a.toArray(), ...b.toArray()]), line);
    } else if (obstacle.kind === "sphere") {
      const centre = spatial(obstacle.centre);
      solid = new THREE.Mesh(
        obstacle.cavity
          ? new THREE.RingGeometry(obstacle.radius, size, SEGMENTS)
          : new THREE.CircleGeometry(obstacle.radius, SEGMENTS),
        fill,
      );
      solid.position.copy(centre);
      edge = outline(circle(centre, obstacle.radius), line);
    } else if (obstacle.kind === "polygon") {
      const corners = obstacle.points.map(spatial);
      solid = new THREE.Mesh(new THREE.ShapeGeometry(new THREE.Shape(corners)), fill);
      edge = outline(corners, line);
    } else {
      const low = spatial(obstacle.corner);
      const [width, height] = obstacle.size;
      solid = new THREE.Mesh(new THREE.PlaneGeometry(width, height), fill);
      solid.position.set(low.x + width / 2, low.y + height / 2, 0);
      const corners = [[0, 0], [width, 0], [width, height], [0, height]];
      edge = outline(corners.map(([x, y]) => new THREE.Vector3(low.x + x, low.y + y, 0)), line);
    }
    solid.position.z = -0.02 * box.size;
    edge.position.z = -0.03 * box.size;
    group.add(solid, edge);
    return group;
  }

  function footOn(point, normal, from) {
    return from.clone().addScaledVector(normal, point.clone().sub(from).dot(normal));
  }

  // In space: translucent, and a wall only as seen from its free side.
  function inSpace(obstacle, box, materials) {
    if (obstacle.kind === "plane") return wall(obstacle, box, materials);
    const group = new THREE.Group();
    const material = obstacle.cavity ? materials.inside : materials.outside;
    let shape;
    if (obstacle.kind === "sphere") {
      shape = new THREE.Mesh(new THREE.SphereGeometry(obstacle.radius, 64, 32), material);
      shape.position.copy(spatial(obstacle.centre));
    } else if (obstacle.kind === "cylinder") {
      const axis = spatial(obstacle.axis).normalize();
      const point = spatial(obstacle.point);
      const height = 1.4 * box.size;
      shape = new THREE.Mesh(new THREE.CylinderGeometry(obstacle.radius, obstacle.radius, height, 96, 1, true), material);
      shape.quaternion.copy(new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), axis));
      shape.position.copy(point).addScaledVector(axis, box.centre.clone().sub(point).dot(axis));
    } else if (obstacle.kind === "box") {
      const [x, y, z] = obstacle.size;
      shape = new THREE.Mesh(new THREE.BoxGeometry(x, y, z), material);
      shape.position.copy(spatial(obstacle.corner)).add(new THREE.Vector3(x / 2, y / 2, z / 2));
    } else {
      const shared = new THREE.BufferGeometry();
      shared.setAttribute("position", new THREE.BufferAttribute(obstacle.points.array, 3));
      shared.setIndex(new THREE.BufferAttribute(obstacle.triangles.array, 1));
      const geometry = shared.toNonIndexed(); // so that every triangle has its own normal
      geometry.computeVertexNormals();
      shape = new THREE.Mesh(geometry, material);
    }
    group.add(shape);
    return group;
  }

  function wall(obstacle, box, { wall: material, line }) {
    const normal = spatial(obstacle.normal).normalize();
    const point = spatial(obstacle.point);
    const foot = footOn(point, normal, box.centre);
    const helper = Math.abs(normal.z) < 0.9 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
    const first = helper.clone().cross(normal).normalize();
    const second = normal.clone().cross(first);
    const reach = (direction) => 0.56 * box.extent.reduce((sum, e, k) => sum + e * Math.abs(direction.getComponent(k)), 0)
      + 0.03 * box.size;
    const [u, v] = [reach(first), reach(second)];
    const at = (a, b) => foot.clone().addScaledVector(first, a).addScaledVector(second, b);
    const corners = [at(-u, -v), at(u, -v), at(u, v), at(-u, v)];
    const geometry = new THREE.BufferGeometry();
    const points = new Float32Array([0, 1, 2, 0, 2, 3].flatMap((i) => corners[i].toArray()));
    geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    const group = new THREE.Group();
    const grid = [];
    const cell = Math.max(u, v) / 5;
    for (let a = 0; a <= u; a += cell) for (const s of a ? [a, -a] : [0]) grid.push(...at(s, -v).toArray(), ...at(s, v).toArray());
    for (let b = 0; b <= v; b += cell) for (const s of b ? [b, -b] : [0]) grid.push(...at(-u, s).toArray(), ...at(u, s).toArray());
    group.add(new THREE.Mesh(geometry, material), outline(corners, line), lines(new Float32Array(grid), line));
    group.userData.wall = { normal, foot };
    return group;
  }

  return { make };
})();
