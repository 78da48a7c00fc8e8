// The report page of a run in headless Chromium: what it shows is what the
// run's files say, it plays, and nothing complains.
//   node report_page.mjs --modules=DIR --run=RUN [--page=FILE] [--pictures=DIR]
// DIR has node_modules/playwright-core. Exit status 77: no Chromium here.

import assert from 'node:assert/strict';
import {existsSync, readdirSync, readFileSync, statSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {parseArgs} from 'node:util';

const {values: flags} = parseArgs({options: {
  modules: {type: 'string'}, run: {type: 'string'}, page: {type: 'string'},
  pictures: {type: 'string'},
}});
const browser_path = ['/usr/bin/chromium', '/usr/bin/chromium-headless-shell',
                      '/usr/bin/google-chrome'].find(existsSync);
const modules = resolve(flags.modules, 'node_modules');
if (!browser_path || !existsSync(modules)) {
  console.log('Chromium or playwright-core not found: the page of a run was ' +
              'not looked at');
  process.exit(77);
}
const {chromium} = createRequire(join(modules, 'x.js'))('playwright-core');

/** Lines of frames.jsonl. */
const frames = readFileSync(join(flags.run, 'frames.jsonl'), 'utf8')
    .trim().split('\n').map(line => JSON.parse(line));
const summary = JSON.parse(readFileSync(join(flags.run, 'summary.json')));

const surfaceIn = (frame, id) => frame.surfaces.find(one => one.id === id);
const lastRound = surface => surface?.rounds.at(-1);

/** What charts of a surface have to show, from the files alone:
    title -> series -> values by frame, null where there is none. */
function expectedOf(id) {
  const all = frames.map(frame => surfaceIn(frame, id));
  const rounds = all.map(lastRound);
  const byName = (values) => {
    const names = new Set(values.flatMap(row => Object.keys(row ?? {})));
    return Object.fromEntries([...names].map(
        name => [name, values.map(row => row?.[name] ?? null)]));
  };
  const costs = rounds.map(round => {
    const row = {};
    for (const {term, final} of round?.solver.terms ?? []) {
      row[term] = (row[term] ?? 0) + final;
    }
    return row;
  });
  const points = rounds.map(round => {
    const {model_points, ...rest} = round?.association ?? {};
    return rest;
  });
  return {
    'cost of the last round, by term': byName(costs),
    'model points of the last round': byName(points),
    'point-to-plane residual, RMS, mm': {residual: all.map(
        one => one?.rounds.length ? 1000 * one.residual_rms : null)},
    'iterations of all rounds': {iterations: all.map(
        one => one ? one.rounds.reduce(
            (sum, round) => sum + round.solver.iterations, 0) : null)},
    'seconds': byName(all.map(one => one?.seconds)),
    'nodes': {nodes: all.map(one => one?.nodes ?? null)},
    'live pixels': {pixels: all.map(one => one?.pixels ?? null)},
  };
}

/** Vertices of a binary little-endian PLY, whose properties are floats and
    bytes. */
function readVertices(path) {
  const bytes = readFileSync(path);
  const end = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const head = bytes.toString('latin1', 0, end);
  const count = Number(/element vertex (\d+)/.exec(head)[1]);
  const [vertexPart] = head.split('element face');
  const types = [...vertexPart.matchAll(/property (\w+) /g)].map(m => m[1]);
  const size = types.reduce((s, type) => s + (type === 'float' ? 4 : 1), 0);
  return Array.from({length: count}, (_, i) => [0, 4, 8].map(
      k => bytes.readFloatLE(end + i * size + k)));
}

const browser = await chromium.launch({
  executablePath: browser_path,
  args: ['--no-sandbox', '--use-angle=swiftshader',
         '--enable-unsafe-swiftshader', '--disable-background-networking'],
});
const page = await browser.newPage({viewport: {width: 1360, height: 900}});
const complaints = [];
page.on('console', message => {
  // Drivers of software renderers remark on their speed.
  if (['error', 'warning'].includes(message.type()) &&
      !/GPU stall|GL Driver Message/.test(message.text())) {
    complaints.push(message.text());
  }
});
page.on('pageerror', error => complaints.push(error.message));
page.on('request', request => {
  if (!/^(file|data|blob):/.test(request.url())) complaints.push(request.url());
});

async function shoot(name, whole = true) {
  if (!flags.pictures) return;
  await page.screenshot({path: join(flags.pictures, name), fullPage: whole});
}

/** All charts with their data as the page has them. */
async function checkCharts() {
  const charts = await page.evaluate(() => splitfusion.charts);
  const per_surface = Object.keys(expectedOf(0)).length;
  assert.equal(charts.length, 1 + per_surface * summary.surfaces.length);
  const numbers = frames.map(frame => frame.frame);
  const same = (chart, expected) => {
    assert.deepEqual(chart.x, numbers);
    for (const {name, values} of chart.series) {
      assert.deepEqual(values, expected[name], `${chart.title}: ${name}`);
    }
    assert.equal(chart.series.length, Object.keys(expected).length);
  };
  const {total, ...parts} = Object.fromEntries(
      Object.keys(frames[0].seconds).map(
          part => [part, frames.map(frame => frame.seconds[part])]));
  same(charts[0], parts);
  summary.surfaces.forEach(({id}, s) => {
    const expected = expectedOf(id);
    for (const chart of charts.slice(1 + s * per_surface,
                                     1 + (s + 1) * per_surface)) {
      same(chart, expected[chart.title]);
    }
  });
}

/** The first chart tells values, is zoomed, and goes with keys. */
async function checkChartInUse() {
  const figure = page.locator('figure.chart').first();
  await figure.scrollIntoViewIfNeeded();
  await page.waitForFunction(
      () => document.querySelector('figure.chart').plot);
  await figure.focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  const told = await figure.evaluate(element => Object.fromEntries(
      [...element.querySelectorAll('.u-series')].map(
          row => [row.querySelector('.u-label').textContent,
                  row.querySelector('.u-value').textContent])));
  const {plotted} = await figure.evaluate(
      element => ({plotted: element.plot.cursor.idx}));
  assert.equal(told.frame, String(frames[plotted].frame));
  const {total, ...parts} = frames[plotted].seconds;
  for (const [part, seconds] of Object.entries(parts)) {
    assert.equal(Number(told[part]), Number(seconds.toPrecision(4)), part);
  }
  const range = () => figure.evaluate(
      ({plot}) => plot.scales.x.max - plot.scales.x.min);
  const all = await range();
  await page.keyboard.press('+');
  assert.ok(await range() < all, 'keys zoom');
  await page.keyboard.press('Escape');
  assert.equal(await range(), all);
  const box = await figure.locator('.u-over').boundingBox();
  await page.mouse.move(box.x + box.width / 4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + 40, {steps: 4});
  await page.mouse.up();
  assert.ok(await range() < .5 * all, 'dragging zooms');
  await figure.focus();
  await page.keyboard.press('Escape');
}

/** The viewer carries vertices where warped/FRAME.ply has them. */
async function checkSurfaces() {
  let compared = 0, largest = 0;
  for (const {id, label} of summary.surfaces) {
    const name = `${String(id).padStart(3, '0')}_${label}`;
    const folder = join(flags.run, 'surfaces', name, 'warped');
    if (!existsSync(folder)) continue;
    for (const file of readdirSync(folder)) {
      const frame = Number(file.slice(0, 6));
      const {warped, source, corners} = await page.evaluate(
          async ({name, frame}) => {
            const [viewer] = await splitfusion.viewers;
            viewer.show(viewer.data.frames.indexOf(frame));
            const view = viewer.views.find(one => one.surface.name === name);
            return {warped: [...view.warped], source: [...view.surface.source],
                    corners: view.mesh.geometry.drawRange.count};
          }, {name, frame});
      const vertices = readVertices(join(folder, file));
      source.forEach((index, i) => {
        const off = Math.hypot(...[0, 1, 2].map(
            k => warped[3 * i + k] - vertices[index][k]));
        largest = Math.max(largest, off);
        ++compared;
      });
      assert.ok(corners > 0, `${name} has triangles in frame ${frame}`);
    }
  }
  assert.ok(compared > 0, 'there are warped meshes');
  assert.ok(largest < 1e-4, `vertices are ${1000 * largest} mm off`);
  console.log(`${compared} vertices in motion: at most ` +
              `${(1000 * largest).toFixed(3)} mm from warped/`);
}

/** It plays, steps with keys, and takes the charts along. */
async function checkPlays() {
  const index = () => page.evaluate(
      async () => (await splitfusion.viewers)[0].index);
  await page.locator('.viewer button').click();
  await page.waitForFunction(async before => {
    const [viewer] = await splitfusion.viewers;
    return viewer.index !== before;
  }, await index());
  await page.locator('.viewer button').click();
  await page.locator('.viewer input[type=range]').fill('0');
  await page.locator('.viewer canvas').first().focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await index(), 1);
  assert.match(await page.locator('.viewer output').textContent(),
               new RegExp(`^frame ${frames[1].frame}\\b`));
  const cursor = await page.locator('figure.chart').first().evaluate(
      element => element.plot.cursor.idx);
  assert.equal(cursor, 1, 'charts show the frame');
  for (const mode of await page.locator('.viewer select').first()
           .locator('option').evaluateAll(all => all.map(one => one.value))) {
    await page.locator('.viewer select').first().selectOption(mode);
    for (const bar of await page.locator('.viewer .scale').all()) {
      const {width, height} = await bar.boundingBox();
      assert.ok(width < 200 && height < 20, `${mode}: a bar of colours`);
    }
  }
  await page.locator('.viewer select').first().selectOption('color');
  // Something is drawn: not all of the picture is the background.
  const colors = await page.evaluate(async () => {
    const [viewer] = await splitfusion.viewers;
    viewer.draw();
    const gl = viewer.renderer.getContext();
    const pixels = new Uint8Array(
        4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA,
                  gl.UNSIGNED_BYTE, pixels);
    return new Set(new Uint32Array(pixels.buffer)).size;
  });
  assert.ok(colors > 20, `${colors} colours are drawn`);
}

async function checkNarrowAndDark() {
  await shoot('wide.png');
  await page.setViewportSize({width: 420, height: 800});
  await page.waitForTimeout(300);
  const width = await page.evaluate(
      () => document.documentElement.scrollWidth);
  assert.ok(width <= 420, `a narrow page is ${width} pixels wide`);
  await shoot('narrow.png');
  await page.setViewportSize({width: 1360, height: 900});
  await page.emulateMedia({colorScheme: 'dark'});
  await page.waitForTimeout(300);
  const [ink, paper] = await page.evaluate(() => {
    const style = getComputedStyle(document.body);
    return [style.color, getComputedStyle(document.documentElement)
                             .colorScheme];
  });
  assert.match(paper, /dark/);
  assert.notEqual(ink, 'rgb(0, 0, 0)');
  await shoot('dark.png');
  await page.emulateMedia({colorScheme: 'light', media: 'print'});
  assert.ok(await page.locator('figure.chart > svg').first().isVisible());
  assert.ok(!await page.locator('figure.chart > .plot').first().isVisible());
}

try {
  const file = resolve(flags.page ?? join(flags.run, 'report.html'));
  const since = Date.now();
  await page.goto(`file://${file}`);
  const viewers = await page.evaluate(
      async () => (await splitfusion.viewers).filter(Boolean).length);
  console.log(`${(statSync(file).size / 1e6).toFixed(2)} MB, ready after ` +
              `${((Date.now() - since) / 1000).toFixed(2)} s`);
  assert.equal(viewers, 1);
  await checkCharts();
  await checkChartInUse();
  await checkSurfaces();
  await checkPlays();
  await checkNarrowAndDark();
  assert.deepEqual(complaints, []);
  console.log('page: all checks passed');
} finally {
  await browser.close();
}
