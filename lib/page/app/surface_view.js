// One surface of a scene in the viewer: its mesh and its deformation graph.

import {
  BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group,
  LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial,
  MeshNormalMaterial,
} from 'three';
import {
  blendValues, nodeMaps, visibleTriangles, warpNodes, warpVertices,
} from './warp.js';

const kUnknown = [.5, .5, .5];

/** Blue over white to red, of 0 to 1, as displays take it. */
export function heat(share) {
  const s = Math.min(Math.max(share, 0), 1);
  return s < .5 ? [.2 + 1.6 * s, .35 + 1.3 * s, .8 + .4 * s] :
                  [1 - .5 * (s - .5), 1 - 1.8 * (s - .5), 1 - 1.8 * (s - .5)];
}

/** The same as light, which three.js reckons with. */
function light(color) {
  return color.map(value => value ** 2.2);
}

/** How a mesh is shown. */
const kMaterials = {
  color: new MeshBasicMaterial({vertexColors: true, side: DoubleSide}),
  shape: new MeshLambertMaterial(
      {color: 0xd0d0d0, flatShading: true, side: DoubleSide}),
  normals: new MeshNormalMaterial({flatShading: true, side: DoubleSide}),
};

export class SurfaceView {
  /** `surface`: as unpackSurface() gives it. */
  constructor(surface) {
    this.surface = surface;
    this.group = new Group();
    this.warped = new Float32Array(surface.vertices.length);
    this.corners = new Uint32Array(surface.triangles.length);
    this.values = new Float32Array(surface.vertices.length / 3);
    this.mesh = this.#makeMesh();
    this.graph = this.#makeGraph();
    this.group.add(this.mesh, this.graph);
  }

  #makeMesh() {
    const geometry = new BufferGeometry();
    const dynamic = (array, size) =>
        new BufferAttribute(array, size).setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', dynamic(this.warped, 3));
    this.colors = Float32Array.from(
        this.surface.colors, value => (value / 255) ** 2.2);
    geometry.setAttribute(
        'color', dynamic(new Float32Array(this.colors.length), 3));
    geometry.setIndex(dynamic(this.corners, 1));
    const mesh = new Mesh(geometry, kMaterials.color);
    mesh.frustumCulled = false;
    return mesh;
  }

  #makeGraph() {
    const geometry = new BufferGeometry();
    this.nodes = new Float32Array(3 * this.surface.nodes);
    this.ends = new Uint32Array(this.surface.edges.length);
    geometry.setAttribute(
        'position',
        new BufferAttribute(this.nodes, 3).setUsage(DynamicDrawUsage));
    geometry.setIndex(
        new BufferAttribute(this.ends, 1).setUsage(DynamicDrawUsage));
    const lines = new LineSegments(
        geometry, new LineBasicMaterial({color: 0xffc020}));
    lines.frustumCulled = false;
    lines.renderOrder = 1;
    lines.material.depthTest = false;
    return lines;
  }

  /** Shows the surface in the `index`-th frame of the scene, as `mode` says.
      Returns whether it is there. */
  show(index, mode, withGraph) {
    const at = this.surface.frames.indexOf(index);
    this.group.visible = at >= 0;
    if (at < 0) return false;
    if (at !== this.at) this.#warp(at, index);
    this.at = at;
    this.#paint(index, mode);
    this.graph.visible = withGraph && this.surface.edges.length > 0;
    return true;
  }

  #warp(at, index) {
    const {surface, warped, nodes, corners, ends} = this;
    const maps = nodeMaps(surface, at);
    warpVertices(surface, maps, warped);
    warpNodes(surface, maps, nodes);
    const count = visibleTriangles(surface, index, warped, corners);
    this.mesh.geometry.setDrawRange(0, count);
    let drawn = 0;
    for (let e = 0; e < surface.edges.length; e += 2) {
      const a = surface.edges[e], b = surface.edges[e + 1];
      const used = n => index >= surface.used[2 * n] &&
                        index < surface.used[2 * n + 1];
      if (!used(a) || !used(b)) continue;
      ends[drawn++] = a;
      ends[drawn++] = b;
    }
    this.graph.geometry.setDrawRange(0, drawn);
    for (const geometry of [this.mesh.geometry, this.graph.geometry]) {
      geometry.attributes.position.needsUpdate = true;
      geometry.index.needsUpdate = true;
    }
  }

  #paint(index, mode) {
    const field = this.surface.fields?.[mode];
    this.mesh.material = kMaterials[mode] ?? kMaterials.color;
    if (this.mesh.material !== kMaterials.color) return;
    if (!field && this.painted === 'color') return;
    this.painted = field ? mode : 'color';
    const color = this.mesh.geometry.attributes.color;
    if (field) this.#paintField(field, mode, index, color.array);
    else color.array.set(this.colors);
    color.needsUpdate = true;
  }

  /** Colours by a value of the nodes, if need be that of an earlier frame. */
  #paintField(field, mode, index, out) {
    const {nodes} = this.surface;
    const row = field.frames.findLastIndex(
        frame => field.holds ? frame <= index : frame === index);
    if (row < 0) {
      this.values.fill(NaN);
    } else {
      blendValues(this.surface,
                  this.surface[mode].subarray(
                      row * nodes, (row + 1) * nodes), this.values);
    }
    for (let i = 0; i < this.values.length; ++i) {
      const value = this.values[i] * field.unit / field.top;
      const [r, g, b] = light(
          Number.isNaN(value) ? kUnknown : heat(value));
      out[3 * i] = r;
      out[3 * i + 1] = g;
      out[3 * i + 2] = b;
    }
  }
}
