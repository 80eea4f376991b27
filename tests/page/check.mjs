// What a browser makes of the page that room.yaml became, and what the validator of glTF says of its GLB file.
//   node check.mjs MODULES FOLDER      FOLDER holds the files that render wrote, and takes a browser's profile
import {readFileSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [modules, folder] = process.argv.slice(2);
const require = createRequire(resolve(modules, 'package.json'));
const {chromium} = require('playwright-core');
const validator = require('gltf-validator');

const file = name => join(folder, name);
let passed = 0, failed = 0;
function check(good, text) {
  if (good) ++passed;
  else {
    ++failed;
    console.error(`failed: ${text}`);
  }
}
const near = (a, b, share) => Math.abs(a - b) <= share * Math.max(Math.abs(a), Math.abs(b)) + 1e-12;

// ---- The GLB file.

const report = await validator.validateBytes(new Uint8Array(readFileSync(file('room.glb'))));
check(report.issues.numErrors === 0 && report.issues.numWarnings === 0, `GLB: ${JSON.stringify(report.issues.messages)}`);
check(report.info.drawCallCount === 3, `GLB: three things, not ${report.info.drawCallCount}`);

// ---- The page, in a browser that may reach nothing.

const browser = await chromium.launchPersistentContext(file('profile'), {
  executablePath: '/usr/bin/chromium',
  headless: true,
  offline: true,
  viewport: {width: 640, height: 480},
  args: [
    '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync',
  ],
});

async function open(path) {
  const page = await browser.newPage(), complaints = [];
  page.on('console', message => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', error => complaints.push(error.message));
  page.on('request', request => {
    if (request.url() !== pathToFileURL(path).href && !request.url().startsWith('data:'))
      complaints.push(`asks for ${request.url()}`);
  });
  await page.goto(pathToFileURL(path).href);
  return {page, complaints};
}

// Before the page: only the newest one is in front, and those behind it are drawn once a second.
const canvas = await browser.newPage();
const {page, complaints} = await open(file('room.html'));
await page.waitForSelector('html.ready', {timeout: 20000});

// The scene alone, as a PNG.
async function picture() {
  await page.waitForSelector('#view:not(.moving)');
  const hide = on => page.evaluate(hidden => {
    for (const element of document.querySelectorAll('header, #controls, #panel'))
      element.style.visibility = hidden ? 'hidden' : '';
    return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
  }, on);
  await hide(true);
  const png = await page.screenshot();
  await hide(false);
  return png;
}

// Mean difference of two pictures, levels of 0 to 255.
const compare = (a, b) =>
  canvas.evaluate(async pictures => {
    const [one, other] = await Promise.all(pictures.map(async text => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${text}`)).blob());
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height);
    }));
    if (one.width !== other.width || one.height !== other.height) return Infinity;
    let sum = 0;
    for (let k = 0; k < one.data.length; ++k) sum += Math.abs(one.data[k] - other.data[k]);
    return sum / (one.width * one.height * 3);
  }, [a, b].map(png => png.toString('base64')));

const text = selector => page.textContent(selector);
const setSlider = (selector, value) =>
  page.$eval(selector, (slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event('input', {bubbles: true}));
  }, value);

const title = "<script>document.title = 'broken'</script> & <b>room</b>";
check(await text('#title') === title, 'the title is shown as text');
check(await page.$$eval('#title *', list => list.length) === 0, 'the title makes no elements');
check(await page.title() === `${title} - patchlight`, 'the title names the page');
const names = await page.$$eval('#camera option', options => options.map(option => option.textContent));
check(names.join() === 'front,corner', `cameras: ${names}`);

// Levels of a display are whole and dithered: half a level each is usual. Triangles bend where the program's surface is
// bilinear, and edges are smoothed by fewer samples.
const last = await picture();
const program = pass => readFileSync(file(`room-front-pass-${pass}.png`));
const beside = await compare(last, program('16'));
check(beside < 1, `the page looks like the program's picture; mean difference ${beside} levels`);
check(await compare(last, await picture()) === 0, 'two pictures of one state are equal');

await setSlider('#pass', 0);
const first = await picture();
const besideFirst = await compare(first, program('01'));
check(besideFirst < 1, `the page looks like the program's picture of pass 1; mean difference ${besideFirst} levels`);
check(await compare(first, last) > 5, 'the slider of passes changes the picture');
check((await text('#pass-number')).startsWith('1 of '), 'the slider says the pass');
await page.keyboard.press('Space');
await page.waitForFunction(() => document.getElementById('pass').value > 1);
await page.click('#play');
await setSlider('#pass', 99);
await setSlider('#exposure', -1);
check(await compare(await picture(), last) > 10, 'the slider of exposure changes the picture');
await setSlider('#exposure', 0);

await page.focus('#view');
await page.keyboard.press('2');
const flat = await picture();
check(await compare(flat, last) > 0.2, 'flat is not smooth');
await page.keyboard.press('m');
check(await compare(await picture(), flat) > 1, 'lines of the mesh are seen');
await page.keyboard.press('m');
await page.keyboard.press('3');
check(await compare(await picture(), flat) > 20, 'wires are not surfaces');
await page.keyboard.press('1');
check(await compare(await picture(), last) === 0, 'smooth again');

// ---- The camera.

async function drag(x, y) {
  await page.mouse.move(320, 200);
  await page.mouse.down();
  await page.mouse.move(320 + x, 200 + y, {steps: 4});
  await page.mouse.up();
}
await drag(60, 10);
check(await compare(await picture(), last) > 5, 'dragging orbits');
check(await page.isHidden('#panel'), 'dragging picks nothing');
await page.keyboard.press('r');
check(await compare(await picture(), last) < 0.01, 'reset goes back to the camera');
await page.keyboard.press('f');
await drag(60, 10);
const turned = await picture();
check(await compare(turned, last) > 5, 'dragging looks about when walking');
await page.click('#outlines + span');
await page.click('#outlines + span');
// On a busy machine the first frames may take longer than a short press.
let walked = 0;
for (let press = 1; press <= 5 && walked <= 2; ++press) {
  await page.keyboard.down('w');
  await page.waitForTimeout(300 * press);
  await page.keyboard.up('w');
  walked = await compare(await picture(), turned);
}
check(walked > 2, 'W walks, with the focus on a control, too');
await page.selectOption('#camera', '1');
const besideCorner = await compare(await picture(), readFileSync(file('room-corner-pass-16.png')));
check(besideCorner < 1, `the second camera looks like the program's; mean difference ${besideCorner} levels`);
await page.selectOption('#camera', '0');

// ---- Patches against the table.

const [head, ...lines] = readFileSync(file('room-patches.csv'), 'utf8').trim().split('\n').map(line => line.split(','));
const patches = lines.map(line => Object.fromEntries(head.map((name, k) => [name, k ? Number(line[k]) : line[k]])));
const rgb = (patch, name) => ['r', 'g', 'b'].map(channel => patch[`${name}_${channel}`]);
const readTable = id => page.$$eval(`#${id} tbody tr`, rows => Object.fromEntries(rows.map(row => [
  row.cells[0].textContent, [...row.cells].slice(1).map(cell => Number(cell.textContent))])));

async function pick(x, y) {
  await page.keyboard.press('Escape');
  await page.waitForSelector('#panel', {state: 'hidden'});
  await page.mouse.click(x, y);
  await page.waitForSelector('#panel:not([hidden])');
  const row = Number(await page.$eval('#panel', panel => panel.dataset.patch));
  return {patch: patches[row], place: await text('#place'), light: await readTable('light-table'),
    power: await readTable('power-table'), unit: (await text('#power-unit')).split(',')[0]};
}

// Taller, so that the controls hide nothing that is clicked.
await page.setViewportSize({width: 960, height: 1000});
for (const [x, y, polygon] of [[60, 440, 'hall.left'], [480, 440, 'hall.back'], [300, 800, 'hall.floor'],
  [480, 200, 'hall.ceiling'], [667, 590, 'pillar.front']]) {
  const {patch, place, light, power, unit} = await pick(x, y);
  check(await text('#polygon') === polygon && patch.polygon === polygon, `${polygon} is picked at ${x}, ${y}: ${patch.polygon}`);
  // Metres a patch in centimetres.
  const at = place.split('at ')[1].split(',').map(Number);
  const away = Math.hypot(at[0] - patch.x, at[1] - patch.y, at[2] - patch.z);
  check(away < Math.sqrt(patch.area), `${polygon}: the place ${at} is on the patch, ${away} from its centre`);
  check(near(Number(place.match(/area (\S+)/)[1]), patch.area, 1e-4), `${polygon}: area, ${place}`);
  check(Number(place.match(/level (\d+)/)[1]) === patch.level, `${polygon}: level, ${place}`);
  const radiosity = Object.entries(light).find(([name]) => name.startsWith('Radiosity'))[1];
  const scale = {W: 1, mW: 1e-3, 'µW': 1e-6}[unit];
  for (let k = 0; k < 3; ++k) {
    const [emission, reflectance, value] = [rgb(patch, 'emission')[k], rgb(patch, 'reflectance')[k], rgb(patch, 'radiosity')[k]];
    check(near(light.Emission[k], emission, 1e-4), `${polygon}: emission`);
    check(near(light.Reflectance[k], reflectance, 1e-4), `${polygon}: reflectance`);
    check(near(radiosity[k], value, 1e-4), `${polygon}: radiosity ${radiosity} is ${rgb(patch, 'radiosity')}`);
    check(near(power.Sent[k] * scale, value * patch.area * 1e-4, 2e-4), `${polygon}: sent`);
    check(near(power.Received[k] * (1 - reflectance), power.Absorbed[k], 2e-4), `${polygon}: absorbed`);
    check(near(power.Sent[k], power.Received[k] - power.Absorbed[k], 1e-3), `${polygon}: what is received and not absorbed is sent`);
  }
}

// The back wall sees the red wall on its right, the green one on its left, the floor below.
await pick(480, 440);
const seen = await page.$eval('#fisheye', disc => {
  const pen = disc.getContext('2d'), size = disc.width;
  return [[0.93, 0.5], [0.07, 0.5], [0.5, 0.5], [0, 0]].map(
    ([x, y]) => [...pen.getImageData(Math.floor(x * size), Math.floor(y * size), 1, 1).data]);
});
check(seen[0][0] > 2 * seen[0][1], `red on the right of what the back wall sees: ${seen[0]}`);
check(seen[1][1] > 2 * seen[1][0], `green on its left: ${seen[1]}`);
check(Math.abs(seen[2][0] - seen[2][1]) < 30 && seen[2][0] > 60, `the white wall ahead: ${seen[2]}`);
check(seen[3][3] === 0, 'nothing outside of the disc');
await page.keyboard.press('Escape');
check(await page.isHidden('#panel'), 'Escape closes the panel');

check(complaints.length === 0, `the page has no complaints: ${complaints.join('; ')}`);

// ---- Data of another version.

writeFileSync(file('newer.html'), readFileSync(file('room.html'), 'utf8').replace('"version":1', '"version":2'));
const newer = await open(file('newer.html'));
await newer.page.waitForFunction(() => document.getElementById('notice').textContent.includes('cannot be shown'));
check((await newer.page.textContent('#notice')).includes('reads version 1'), 'a newer page is refused in words');

await browser.close();
console.log(`page: ${passed} passed, ${failed} failed`);
process.exit(failed > 0 || passed < 100 ? 1 : 0);
