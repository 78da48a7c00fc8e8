// Carries the vertices of a surface into a frame (SplitFusion Eq. 1 to 3).

/** Affine maps x -> A x + b of all nodes in the `index`-th frame in which the
    surface has motions, 12 numbers each: A row by row, and b. */
export function nodeMaps(surface, index) {
  const {motions, positions, unit, rotation_unit, nodes, frames} = surface;
  const maps = new Float32Array(12 * nodes);
  const stride = nodes * frames.length;
  for (let n = 0; n < nodes; ++n) {
    const at = index * nodes + n;
    let [x, y, z, w] = [0, 1, 2, 3].map(
        c => motions[c * stride + at] * rotation_unit);
    const norm = Math.hypot(x, y, z, w);
    x /= norm; y /= norm; z /= norm; w /= norm;
    const m = maps.subarray(12 * n, 12 * n + 12);
    m[0] = 1 - 2 * (y * y + z * z);
    m[1] = 2 * (x * y - z * w);
    m[2] = 2 * (x * z + y * w);
    m[3] = 2 * (x * y + z * w);
    m[4] = 1 - 2 * (x * x + z * z);
    m[5] = 2 * (y * z - x * w);
    m[6] = 2 * (x * z - y * w);
    m[7] = 2 * (y * z + x * w);
    m[8] = 1 - 2 * (x * x + y * y);
    for (let r = 0; r < 3; ++r) {
      const g = positions.subarray(3 * n, 3 * n + 3);
      m[9 + r] = g[r] + motions[(4 + r) * stride + at] * unit -
                 (m[3 * r] * g[0] + m[3 * r + 1] * g[1] + m[3 * r + 2] * g[2]);
    }
  }
  return maps;
}

/** Vertices in the camera frame, metres, into `out`. */
export function warpVertices(surface, maps, out) {
  const {vertices, influences, weights, per_vertex} = surface;
  for (let i = 0; i < vertices.length / 3; ++i) {
    const x = vertices[3 * i], y = vertices[3 * i + 1], z = vertices[3 * i + 2];
    let px = 0, py = 0, pz = 0, sum = 0;
    for (let k = per_vertex * i; k < per_vertex * (i + 1); ++k) {
      const weight = weights[k];
      if (weight === 0) continue;
      const m = 12 * influences[k];
      px += weight * (maps[m] * x + maps[m + 1] * y + maps[m + 2] * z +
                      maps[m + 9]);
      py += weight * (maps[m + 3] * x + maps[m + 4] * y + maps[m + 5] * z +
                      maps[m + 10]);
      pz += weight * (maps[m + 6] * x + maps[m + 7] * y + maps[m + 8] * z +
                      maps[m + 11]);
      sum += weight;
    }
    out[3 * i] = px / sum;
    out[3 * i + 1] = py / sum;
    out[3 * i + 2] = pz / sum;
  }
}

/** Nodes where they are carried to, camera frame, metres, into `out`. */
export function warpNodes(surface, maps, out) {
  const {positions, nodes} = surface;
  for (let n = 0; n < nodes; ++n) {
    const m = 12 * n;
    for (let r = 0; r < 3; ++r) {
      out[3 * n + r] = maps[m + 3 * r] * positions[3 * n] +
                       maps[m + 3 * r + 1] * positions[3 * n + 1] +
                       maps[m + 3 * r + 2] * positions[3 * n + 2] +
                       maps[m + 9 + r];
    }
  }
}

function edge2(points, a, b) {
  const x = points[3 * a] - points[3 * b];
  const y = points[3 * a + 1] - points[3 * b + 1];
  const z = points[3 * a + 2] - points[3 * b + 2];
  return x * x + y * y + z * z;
}

/** Corners of the triangles that had been seen by a frame, without those that
    lie between parts that have moved apart: an edge is longer than
    `stretched` metres and than twice what it is in the canonical frame, as the
    viewer's triangles are larger than the mesh's. Returns how many corners
    there are in `out`. */
export function visibleTriangles(surface, frame, warped, out) {
  const {triangles, seen, vertices, stretched} = surface;
  const torn = (i, j) => {
    const length = edge2(warped, i, j);
    return length > stretched * stretched &&
           length > 4 * edge2(vertices, i, j);
  };
  let count = 0;
  for (let t = 0; t < triangles.length / 3; ++t) {
    if (frame < seen[2 * t] || frame >= seen[2 * t + 1]) continue;
    const a = triangles[3 * t], b = triangles[3 * t + 1];
    const c = triangles[3 * t + 2];
    if (torn(a, b) || torn(b, c) || torn(c, a)) continue;
    out[count++] = a;
    out[count++] = b;
    out[count++] = c;
  }
  return count;
}

/** A value of all nodes, blended to the vertices; NaN where none is known. */
export function blendValues(surface, values, out) {
  const {vertices, influences, weights, per_vertex} = surface;
  for (let i = 0; i < vertices.length / 3; ++i) {
    let value = 0, sum = 0;
    for (let k = per_vertex * i; k < per_vertex * (i + 1); ++k) {
      const known = values[influences[k]];
      if (weights[k] === 0 || known < 0) continue;
      value += weights[k] * known;
      sum += weights[k];
    }
    out[i] = sum > 0 ? value / sum : NaN;
  }
}
