// Pictures of report pages in headless Chromium, for gallery.sh.
//   node shots.mjs MODULES WORK OUT

import {mkdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';

const [modules, work, out] = process.argv.slice(2).map(path => resolve(path));
const {chromium} = createRequire(join(modules, 'x.js'))('playwright-core');
mkdirSync(out, {recursive: true});

const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader',
         '--enable-unsafe-swiftshader', '--disable-background-networking'],
});
const page = await browser.newPage({viewport: {width: 1360, height: 1000}});

/** Every third frame, while the eye goes round by some degrees. */
async function film(prefix, mode, graph, degrees) {
  await page.setViewportSize({width: 440, height: 480});
  await page.locator('.viewer select').first().selectOption(mode);
  await page.locator('.viewer input[type=checkbox]').first().setChecked(graph);
  const frames = await page.evaluate(
      async () => (await splitfusion.viewers)[0].data.frames.length);
  for (let frame = 0; frame < frames; frame += 3) {
    await page.evaluate(async ({frame, turn}) => {
      const [viewer] = await splitfusion.viewers;
      viewer.show(frame);
      viewer.lookFromBehind();
      const {eye, controls} = viewer;
      eye.position.sub(controls.target).applyAxisAngle(eye.up, turn)
          .multiplyScalar(.8).add(controls.target);
      controls.update();
      viewer.draw();
    }, {frame, turn: degrees * Math.PI / 180 *
                         Math.sin(2 * Math.PI * frame / frames)});
    const name = `${prefix}_${String(frame).padStart(3, '0')}.png`;
    await page.locator('.viewer canvas').first().screenshot(
        {path: join(out, name)});
  }
}

await page.goto(`file://${join(work, 'page.html')}`);
await page.evaluate(
    async () => { (await splitfusion.viewers)[0].show(30); });
await page.waitForTimeout(500);
await page.evaluate(() => scrollTo(
    0, document.querySelector('.viewer').offsetTop - 60));
await page.waitForTimeout(500);
await page.screenshot({path: join(out, 'page.png')});
await film('turn', 'color', true, 40);
await film('residual', 'residual', false, 25);

await page.setViewportSize({width: 1360, height: 1000});
await page.goto(`file://${join(work, 'sweep/report.html')}`);
await page.waitForTimeout(1000);
await page.screenshot({path: join(out, 'sweep.png')});
await browser.close();
