// The page: data -> a picture that can be walked in, its passes, and the numbers of the patch that is clicked.
import * as THREE from 'three';
import {load, unpackLight} from './data.js';
import {makeFisheye} from './fisheye.js';
import {makeMesh} from './mesh.js';
import {makeMover} from './move.js';
import {makePicker} from './pick.js';

const byId = id => document.getElementById(id);
const millisecondsAPass = 450, clickPixels = 4;

// Five digits, and no more zeros than say something.
function format(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(3) : String(Number(value.toPrecision(5)));
}

// The unit of power in which the largest of some watts has a digit before the point.
const powerUnits = [['GW', 1e9], ['MW', 1e6], ['kW', 1e3], ['W', 1], ['mW', 1e-3], ['µW', 1e-6], ['nW', 1e-9]];
const pickPowerUnit = watts => powerUnits.find(([, size]) => watts >= size) ?? powerUnits[watts > 0 ? 6 : 3];

// How the page speaks of what the solver did: of `count` passes or shots, or of one solution.
const steps = {
  pass: {name: 'Pass', all: count => `${count} passes`, growth: 'Radiosity after each pass'},
  shot: {name: 'Shot', all: count => `${count} shots`, growth: 'Radiosity after 1, 2, 4 ... shots'},
  solution: {name: 'Solution', all: () => 'solved at once', growth: ''},
};

function start(data) {
  const {header, polygons, light} = data, step = steps[header.step], all = light[light.length - 1].pass;
  const renderer = new THREE.WebGLRenderer({canvas: byId('view'), antialias: true, powerPreference: 'high-performance'});
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x0d0e10);
  const camera = new THREE.PerspectiveCamera(60, 1, 1e-3, 200);
  const mesh = makeMesh(data), pick = makePicker(data), fisheye = makeFisheye(renderer);
  scene.add(mesh.group);
  const frame = new THREE.LineLoop(
    new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: 0x6fe3ff, depthTest: false, toneMapped: false}));
  frame.visible = frame.frustumCulled = false;
  scene.add(frame);

  let view = header.cameras[0], picked = null, passIndex = light.length - 1, playing = 0, gain = 1;
  let fast = false, drawn = false, last = 0;
  const redraw = () => {
    if (!drawn) requestAnimationFrame(draw);
    drawn = true;
  };
  const mover = makeMover(camera, renderer.domElement, redraw);

  function draw(now) {
    drawn = false;
    if (mover.step((now - last) / 1000, fast)) redraw();
    last = now;
    renderer.render(scene, camera);
  }

  function resize() {
    renderer.setSize(innerWidth, innerHeight, false);
    camera.aspect = innerWidth / innerHeight;
    // A window narrower than the scene's picture shows as much from left to right.
    const half = Math.tan(THREE.MathUtils.degToRad(view.fov / 2)) * Math.max(1, view.aspect / camera.aspect);
    camera.fov = THREE.MathUtils.radToDeg(2 * Math.atan(half));
    camera.updateProjectionMatrix();
    redraw();
  }

  function goTo(index) {
    view = header.cameras[index];
    mover.start(view);
    resize();
  }

  // ---- What the controls say.

  function showPass(index) {
    passIndex = Math.max(0, Math.min(light.length - 1, index));
    byId('pass').value = passIndex;
    byId('pass-number').textContent = `${light[passIndex].pass} of ${all}`;
    mesh.show(passIndex);
    showPicked();
    redraw();
  }

  function showExposure() {
    const stops = Number(byId('exposure').value);
    gain = 2 ** stops;
    byId('exposure-number').textContent = `EV ${(header.exposure + stops).toFixed(1)}`;
    mesh.setGain(gain);
    showPicked();
    redraw();
  }

  function changeExposure(stops) {
    byId('exposure').value = Number(byId('exposure').value) + stops;
    showExposure();
  }

  function play(on) {
    clearInterval(playing);
    playing = 0;
    byId('play').classList.toggle('playing', on);
    byId('play').ariaLabel = on ? 'Pause' : 'Play the passes';
    if (!on) return;
    if (passIndex === light.length - 1) showPass(0);
    playing = setInterval(() => {
      showPass(passIndex + 1);
      if (passIndex === light.length - 1) play(false);
    }, millisecondsAPass);
  }

  function choose(name, value) {
    document.querySelector(`input[name="${name}"][value="${value}"]`).checked = true;
    if (name === 'surface') mesh.setStyle(value);
    else mover.setMode(value);
    redraw();
  }

  // ---- The patch that was clicked.

  const area = patch => data.area[patch] * header.units_per_length ** 2;
  const triple = (column, row) => [0, 1, 2].map(k => column[3 * row + k]);
  // Passes before the last are kept in nine bits a channel: three digits.
  const radiosityAfter = (index, patch) =>
    index === light.length - 1
      ? triple(data.radiosity, patch)
      : unpackLight(light[index].patch[patch]).map(value => Number((value / 2 ** header.exposure).toPrecision(3)));

  function fillTable(id, rows) {
    byId(id).tBodies[0].replaceChildren(...rows.map(({name, values, now}) => {
      const row = document.createElement('tr');
      row.classList.toggle('now', Boolean(now));
      const head = document.createElement('th');
      head.scope = 'row';
      head.textContent = name;
      row.append(head, ...values.map(value => {
        const cell = document.createElement('td');
        cell.textContent = format(value);
        return cell;
      }));
      return row;
    }));
  }

  // A bar a pass, in the patch's own colour; what is past the shown pass is dim.
  function drawGrowth(patch) {
    const canvas = byId('growth'), pen = canvas.getContext('2d'), {width, height} = canvas;
    const values = light.map((_, index) => Math.max(...radiosityAfter(index, patch)));
    const most = Math.max(...values), step = width / values.length;
    pen.clearRect(0, 0, width, height);
    values.forEach((value, index) => {
      const tall = most > 0 ? (height - 4) * value / most : 0;
      pen.fillStyle = index === passIndex ? '#f4b860' : index < passIndex ? '#a98a55' : '#4a4740';
      pen.fillRect(index * step + 2, height - tall - 2, step - 4, tall + 2);
    });
  }

  function showPicked() {
    byId('panel').hidden = !picked;
    document.body.classList.toggle('picked', Boolean(picked));
    frame.visible = Boolean(picked);
    if (!picked) return;
    const {patch, polygon, point} = picked;
    const emission = polygons.emission[polygon], reflectance = polygons.reflectance[polygon];
    const irradiance = triple(data.irradiance, patch), radiosity = triple(data.radiosity, patch);
    const squareMetres = area(patch) * header.metres_per_unit ** 2 * data.exposed[patch];
    const place = point.toArray().map((value, k) => header.origin[k] + value * header.units_per_length);
    byId('polygon').textContent = polygons.id[polygon];
    byId('place').textContent =
      `patch ${patch}, level ${data.level[patch]}, area ${format(area(patch))} ${header.units}²\nat ` +
      place.map(value => String(Number(value.toFixed(2)))).join(', ').replaceAll('-0,', '0,');
    byId('panel').dataset.patch = patch;
    const shown = light[passIndex].pass;
    fillTable('light-table', [
      {name: 'Emission', values: emission},
      {name: 'Reflectance', values: reflectance},
      ...(shown === all ? [] : [{name: `Radiosity, ${header.step} ${shown}`, values: radiosityAfter(passIndex, patch), now: true}]),
      {name: `Radiosity, ${header.step} ${all}`, values: radiosity, now: shown === all},
    ]);
    const sent = radiosity.map(value => value * squareMetres), received = irradiance.map(value => value * squareMetres);
    const [unit, size] = pickPowerUnit(Math.max(...sent, ...received));
    byId('power-unit').textContent = `${unit}, ${header.step} ${all}`;
    fillTable('power-table', [
      {name: 'Received', values: received.map(value => value / size)},
      {name: 'Absorbed', values: received.map((value, k) => value * (1 - reflectance[k]) / size)},
      {name: 'Sent', values: sent.map(value => value / size)},
    ]);
    drawGrowth(patch);
    // Upwards on walls; on floors and ceilings away from who looks at them.
    const up = camera.up.clone();
    if (Math.abs(up.dot(picked.normal)) > 0.9) camera.getWorldDirection(up);
    const style = document.querySelector('input[name="surface"]:checked').value;
    mesh.setOutlines(false);
    mesh.setStyle(style === 'lines' ? 'smooth' : style);
    fisheye.draw(byId('fisheye'), mesh.group, picked, up, byId('by-share').checked);
    mesh.setOutlines(byId('outlines').checked);
    mesh.setStyle(style);
  }

  function pickAt(x, y) {
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(2 * x / innerWidth - 1, 1 - 2 * y / innerHeight), camera);
    picked = pick(caster.ray);
    if (picked) {
      const corners = [];
      for (let k = data.outlineFirst[picked.patch]; k < data.outlineFirst[picked.patch + 1]; ++k)
        corners.push(new THREE.Vector3().fromArray(data.position, 3 * data.outline[k]));
      frame.geometry.dispose();
      frame.geometry = new THREE.BufferGeometry().setFromPoints(corners);
    }
    showPicked();
    redraw();
  }

  // ---- Events.

  const canvas = renderer.domElement;
  let pressed = null;
  canvas.addEventListener('pointerdown', event => pressed = event.button === 0 ? [event.clientX, event.clientY] : null);
  canvas.addEventListener('pointerup', event => {
    if (pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < clickPixels)
      pickAt(event.clientX, event.clientY);
    pressed = null;
  });
  byId('pass').addEventListener('input', event => {
    play(false);
    showPass(Number(event.target.value));
  });
  byId('exposure').addEventListener('input', showExposure);
  byId('play').addEventListener('click', () => play(!playing));
  byId('outlines').addEventListener('change', event => {
    mesh.setOutlines(event.target.checked);
    redraw();
  });
  byId('controls').addEventListener('change', event => {
    if (event.target.type === 'radio') choose(event.target.name, event.target.value);
    if (event.target.type === 'select-one') goTo(Number(event.target.value));
  });
  byId('home').addEventListener('click', () => goTo(header.cameras.indexOf(view)));
  byId('by-share').addEventListener('change', showPicked);
  const unpick = () => {
    picked = null;
    showPicked();
    redraw();
  };
  byId('panel-close').addEventListener('click', unpick);
  byId('help-button').addEventListener('click', () => byId('help').showModal());
  const actions = {
    Space: () => play(!playing),
    Comma: () => showPass(passIndex - 1),
    Period: () => showPass(passIndex + 1),
    Minus: () => changeExposure(-0.5),
    NumpadSubtract: () => changeExposure(-0.5),
    Equal: () => changeExposure(0.5),
    BracketRight: () => changeExposure(0.5),
    NumpadAdd: () => changeExposure(0.5),
    Digit1: () => choose('surface', 'smooth'),
    Digit2: () => choose('surface', 'flat'),
    Digit3: () => choose('surface', 'lines'),
    KeyM: () => byId('outlines').click(),
    KeyO: () => choose('mode', 'orbit'),
    KeyF: () => choose('mode', 'walk'),
    KeyR: () => byId('home').click(),
    KeyH: () => byId('help').showModal(),
    Escape: unpick,
  };
  addEventListener('keydown', event => {
    fast = event.shiftKey;
    // What these do with a key is theirs.
    const taken = event.target.closest(event.code === 'Space' ? 'select, dialog, button, input' : 'select, dialog');
    if (!actions[event.code] || taken || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.code]();
  });
  addEventListener('keyup', event => fast = event.shiftKey);
  addEventListener('resize', resize);

  // ---- First picture.

  document.title = header.title ? `${header.title} - patchlight` : 'patchlight';
  byId('title').textContent = header.title || header.scene;
  byId('facts').textContent =
    `${data.level.length.toLocaleString('en')} patches, ${step.all(all)}; light in W/m²`;
  byId('step-name').textContent = step.name;
  byId('growth-name').textContent = step.growth;
  byId('growth-figure').hidden = byId('play').hidden = byId('pass').disabled = light.length === 1;
  if (header.cameras.length > 1) {
    byId('camera').hidden = false;
    byId('camera').append(...header.cameras.map((each, index) => new Option(each.name || `camera ${index + 1}`, index)));
  }
  byId('pass').max = light.length - 1;
  goTo(0);
  choose('surface', header.shading);
  showPass(light.length - 1);
  showExposure();
  renderer.render(scene, camera);
}

async function main() {
  const root = document.documentElement;
  try {
    if (!document.createElement('canvas').getContext('webgl2'))
      throw new Error('this page draws with WebGL 2, which this browser does not offer');
    start(await load());
    root.classList.add('ready');
    root.dataset.milliseconds = Math.round(performance.now());
  } catch (error) {
    byId('notice').textContent = `The scene cannot be shown: ${error.message}`;
    throw error;
  }
}

main();
