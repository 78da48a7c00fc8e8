// Plays the surfaces of a run as they deform.

import {
  AmbientLight, BufferGeometry, Color, DirectionalLight, Group, Line,
  LineBasicMaterial, PerspectiveCamera, Quaternion, Scene, Vector3,
  WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {onFrame, showFrame} from './frames.js';
import {heat, SurfaceView} from './surface_view.js';
import {inflate, unpackSurface} from './unpack.js';

const kFramesPerSecond = 15;
// Browsers take the picture from the oldest of more than about 16.
const kViewers = 8;

/** An element with attributes and children. */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  Object.assign(made, attributes);
  made.append(...children);
  return made;
}

/** A labelled control. */
function labelled(text, control) {
  return element('label', {}, control, ' ' + text);
}

/** A bar of the colours of a field, with its ends. */
function scaleOf(field) {
  const canvas = element('canvas', {className: 'scale', width: 120, height: 1});
  const context = canvas.getContext('2d');
  for (let x = 0; x < 120; ++x) {
    const [r, g, b] = heat(x / 119).map(c => Math.round(255 * c));
    context.fillStyle = `rgb(${r},${g},${b})`;
    context.fillRect(x, 0, 1, 1);
  }
  return element('span', {}, '0 ', canvas,
                 ` ${1000 * field.top} mm and more; grey: not known; ` +
                 'a background that does not deform has its colours');
}

class Viewer {
  constructor(place, scene, views) {
    this.place = place;
    this.data = scene;
    this.views = views;
    this.index = 0;
    this.#makeScene();
    this.#makeControls();
    onFrame(scene.run, this, frame => this.#goTo(frame));
    addEventListener('resize', () => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.show(0);
    this.lookFromBehind();
  }

  #makeScene() {
    this.canvas = element('canvas', {tabIndex: 0});
    this.canvas.setAttribute(
        'aria-label', 'surfaces in 3D: space plays, arrows step; drag turns, ' +
                      'right button moves, wheel zooms');
    this.canvas.setAttribute('role', 'application');
    this.place.append(this.canvas);
    this.renderer = new WebGLRenderer({canvas: this.canvas, antialias: true});
    this.scene = new Scene();
    this.scene.background = new Color(0x808890);
    // x right, y down, z forward, as a camera has them.
    this.world = new Group();
    this.world.rotation.x = Math.PI;
    this.scene.add(this.world);
    // What moves with the live camera.
    this.rig = new Group();
    this.world.add(this.rig);
    for (const view of this.views) this.rig.add(view.group);
    this.world.add(this.#wayOfCamera());
    this.eye = new PerspectiveCamera(50, 1, .02, 200);
    const light = new DirectionalLight(0xffffff, 2.2);
    light.position.set(.3, .5, 1);
    this.eye.add(light);
    this.scene.add(this.eye, new AmbientLight(0xffffff, .7));
    this.controls = new OrbitControls(this.eye, this.canvas);
    this.controls.addEventListener('change', () => this.draw());
  }

  #wayOfCamera() {
    const points = this.data.poses.map(p => new Vector3(p[0], p[1], p[2]));
    return new Line(new BufferGeometry().setFromPoints(points),
                    new LineBasicMaterial({color: 0x2060ff}));
  }

  #makeControls() {
    const last = this.data.frames.length - 1;
    this.button = element('button', {type: 'button', textContent: 'Play',
                                     onclick: () => this.toggle()});
    this.slider = element('input', {
      type: 'range', min: 0, max: last, value: 0,
      oninput: () => this.#step(Number(this.slider.value)),
    });
    this.slider.setAttribute('aria-label', 'frame');
    this.output = element('output');
    const modes = [['color', 'colour'], ['shape', 'shape'],
                   ['normals', 'normals'],
                   ...Object.entries(this.data.fields).map(
                       ([name, field]) => [name, field.title])];
    this.mode = element('select', {onchange: () => this.refresh()},
        ...modes.map(([value, textContent]) =>
            element('option', {value, textContent})));
    this.eyeMode = element('select', {onchange: () => this.#changeEye()},
        element('option', {value: 'free', textContent: 'from anywhere'}),
        element('option', {value: 'live', textContent: 'with the camera'}));
    this.withGraph = element('input', {type: 'checkbox',
                                       onchange: () => this.refresh()});
    const shown = this.views.map(view => {
      view.box = element('input', {type: 'checkbox', checked: true,
                                   onchange: () => this.refresh()});
      return labelled(view.surface.name, view.box);
    });
    this.scale = element('span');
    this.place.append(element('form', {onsubmit: () => false},
        this.button, this.slider, this.output),
        element('form', {onsubmit: () => false},
            labelled('', this.mode), labelled('', this.eyeMode),
            labelled('graph', this.withGraph), ...shown, this.scale));
    this.mode.setAttribute('aria-label', 'colours');
    this.eyeMode.setAttribute('aria-label', 'view');
    this.canvas.addEventListener('keydown', event => this.#onKey(event));
  }

  #onKey(event) {
    if (event.key === ' ') this.toggle();
    else if (event.key === 'ArrowRight') this.#step(this.index + 1);
    else if (event.key === 'ArrowLeft') this.#step(this.index - 1);
    else return;
    event.preventDefault();
  }

  #changeEye() {
    if (this.eyeMode.value === 'free') this.lookFromBehind();
    this.controls.enabled = this.eyeMode.value === 'free';
    this.refresh();
  }

  /** The frame that others show, or the last one before it. */
  #goTo(frame) {
    const at = this.data.frames.findLastIndex(other => other <= frame);
    this.show(Math.max(at, 0));
  }

  /** Shows a frame, and has the charts show it. */
  #step(index) {
    const last = this.data.frames.length - 1;
    this.show(Math.min(Math.max(index, 0), last));
    showFrame(this.data.run, this.data.frames[this.index], this);
  }

  /** Behind and above the camera, towards what it sees. */
  lookFromBehind() {
    this.eye.up.set(0, 1, 0);
    this.world.updateMatrixWorld();
    this.rig.updateMatrixWorld();
    this.controls.target.copy(
        new Vector3(0, 0, 2).applyMatrix4(this.rig.matrixWorld));
    this.eye.position.copy(
        new Vector3(.5, -.5, -.6).applyMatrix4(this.rig.matrixWorld));
    this.eye.fov = 50;
    this.controls.update();
  }

  #followCamera() {
    if (this.eyeMode.value !== 'live') return;
    this.rig.updateMatrixWorld(true);
    this.eye.position.setFromMatrixPosition(this.rig.matrixWorld);
    const ahead = new Vector3(0, 0, 1).applyMatrix4(this.rig.matrixWorld);
    const up = new Vector3(0, -1, 0).transformDirection(this.rig.matrixWorld);
    this.eye.up.copy(up);
    this.eye.lookAt(ahead);
    this.eye.fov = this.data.fov;
  }

  /** Shows the `index`-th frame. */
  show(index) {
    this.index = index;
    const [x, y, z, qx, qy, qz, qw] = this.data.poses[index];
    this.rig.position.set(x, y, z);
    this.rig.quaternion.copy(new Quaternion(qx, qy, qz, qw).normalize());
    this.slider.value = index;
    this.refresh();
  }

  /** Shows the frame again, after a change of what is shown of it. */
  refresh() {
    const states = [];
    for (const view of this.views) {
      const there = view.show(this.index, this.mode.value,
                              this.withGraph.checked);
      view.group.visible = there && view.box.checked;
      const state = view.surface.states[this.index];
      if (state && state !== 'tracked') {
        states.push(`${view.surface.name} ${state}`);
      }
    }
    this.output.value = `frame ${this.data.frames[this.index]}` +
                        (states.length > 0 ? `: ${states.join(', ')}` : '');
    const field = this.data.fields[this.mode.value];
    this.scale.replaceChildren(...(field ? [scaleOf(field)] : []));
    this.#followCamera();
    this.draw();
  }

  draw() {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.eye.aspect = clientWidth / clientHeight;
    this.eye.updateProjectionMatrix();
    this.renderer.render(this.scene, this.eye);
  }

  /** Plays from here on, again from the start after the last frame; or stops.
      */
  toggle() {
    this.playing = !this.playing;
    this.button.textContent = this.playing ? 'Stop' : 'Play';
    cancelAnimationFrame(this.next);
    if (!this.playing) return;
    let before = null;
    const next = now => {
      before ??= now;
      if (now - before >= 1000 / kFramesPerSecond) {
        before = now;
        this.#step((this.index + 1) % this.data.frames.length);
      }
      this.next = requestAnimationFrame(next);
    };
    this.next = requestAnimationFrame(next);
  }
}

/** Makes the viewer of one run in its place. */
async function makeViewer(place) {
  const scene = JSON.parse(place.querySelector('.scene').textContent);
  const bytes = await inflate(place.querySelector('.arrays').textContent);
  const views = [];
  scene.surfaces.forEach(
      header => views.push(new SurfaceView(unpackSurface(bytes, header))));
  return new Viewer(place, scene, views);
}

const viewers = Promise.all(
    [...document.querySelectorAll('.viewer')].map(async (place, i) => {
      try {
        if (i >= kViewers) throw new Error('the page has too many');
        return await makeViewer(place);
      } catch (error) {
        for (const canvas of place.querySelectorAll('canvas')) canvas.remove();
        place.append(
            element('p', {textContent: `No viewer: ${error.message}`}));
        return null;
      }
    }));
window.splitfusion = {...window.splitfusion, viewers};
