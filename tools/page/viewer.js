// The page: data -> a picture that can be walked in, its passes, and the numbers of the patch that is clicked.
import {load} from './data.js';
import {makeMesh} from './mesh.js';
import {makePanel} from './panel.js';
import {makePicker} from './pick.js';
import {makeStage} from './stage.js';

const byId = id => document.getElementById(id);
const millisecondsAPass = 450, clickPixels = 4;

// How the page speaks of what the solver did: of `count` passes or shots, or of one solution.
const steps = {
  pass: {name: 'Pass', all: count => `${count} passes`, growth: 'Radiosity after each pass'},
  shot: {name: 'Shot', all: count => `${count} shots`, growth: 'Radiosity after 1, 2, 4 ... shots'},
  solution: {name: 'Solution', all: () => 'solved at once', growth: ''},
};

const chosen = name => document.querySelector(`input[name="${name}"]:checked`).value;
const select = (name, value) => document.querySelector(`input[name="${name}"][value="${value}"]`).checked = true;

// The texts that do not change, and controls that have something to offer.
function describe({header, level, light}) {
  const step = steps[header.step], last = light[light.length - 1].pass;
  document.title = header.title ? `${header.title} - patchlight` : 'patchlight';
  byId('title').textContent = header.title || header.scene;
  byId('facts').textContent = `${level.length.toLocaleString('en')} patches, ${step.all(last)}; light in W/m²`;
  byId('step-name').textContent = step.name;
  byId('growth-name').textContent = step.growth;
  byId('growth-figure').hidden = byId('play').hidden = byId('pass').disabled = light.length === 1;
  byId('pass').max = light.length - 1;
  byId('camera').hidden = header.cameras.length === 1;
  byId('camera').append(...header.cameras.map((each, index) => new Option(each.name || `camera ${index + 1}`, index)));
  select('surface', header.shading);
}

// What the controls do: each reads its control and shows what it says.
function makeActions(data, mesh, stage, panel) {
  const {header, light} = data, last = light.length - 1;
  let playing = 0, index = last;
  const actions = {
    showPass(next) {
      index = Math.max(0, Math.min(last, next));
      byId('pass').value = index;
      byId('pass-number').textContent = `${light[index].pass} of ${light[last].pass}`;
      mesh.show(index);
      panel.show(index);
    },
    stepPass: by => actions.showPass(index + by),
    changeExposure(stops) {
      byId('exposure').value = Number(byId('exposure').value) + stops;
      actions.showExposure();
    },
    showExposure() {
      const stops = Number(byId('exposure').value);
      byId('exposure-number').textContent = `EV ${(header.exposure + stops).toFixed(1)}`;
      mesh.setGain(2 ** stops);
      panel.show(index);
    },
    showSurface() {
      mesh.setStyle(chosen('surface'));
      mesh.setOutlines(byId('outlines').checked);
      stage.redraw();
    },
    showMode: () => stage.setMode(chosen('mode')),
    goToCamera: () => stage.goTo(header.cameras[Number(byId('camera').value)]),
    play(on = !playing) {
      clearInterval(playing);
      playing = 0;
      byId('play').classList.toggle('playing', on);
      byId('play').ariaLabel = on ? 'Pause' : 'Play the passes';
      if (!on) return;
      if (index === last) actions.showPass(0);
      playing = setInterval(() => {
        actions.stepPass(1);
        if (index === last) actions.play(false);
      }, millisecondsAPass);
    },
    choose(name, value) {
      select(name, value);
      if (name === 'surface') actions.showSurface();
      else actions.showMode();
    },
    help: () => byId('help').showModal(),
  };
  return actions;
}

function bindControls(actions, panel) {
  byId('pass').addEventListener('input', event => {
    actions.play(false);
    actions.showPass(Number(event.target.value));
  });
  byId('exposure').addEventListener('input', actions.showExposure);
  byId('play').addEventListener('click', () => actions.play());
  byId('outlines').addEventListener('change', actions.showSurface);
  for (const radio of document.querySelectorAll('input[type="radio"]'))
    radio.addEventListener('change', () => actions.choose(radio.name, radio.value));
  byId('camera').addEventListener('change', actions.goToCamera);
  byId('home').addEventListener('click', actions.goToCamera);
  byId('help-button').addEventListener('click', actions.help);
  byId('panel-close').addEventListener('click', () => panel.pick(null));
}

function bindKeys(actions, panel, stage) {
  const keys = {
    Space: () => actions.play(),
    Comma: () => actions.stepPass(-1),
    Period: () => actions.stepPass(1),
    Minus: () => actions.changeExposure(-0.5),
    NumpadSubtract: () => actions.changeExposure(-0.5),
    Equal: () => actions.changeExposure(0.5),
    BracketRight: () => actions.changeExposure(0.5),
    NumpadAdd: () => actions.changeExposure(0.5),
    Digit1: () => actions.choose('surface', 'smooth'),
    Digit2: () => actions.choose('surface', 'flat'),
    Digit3: () => actions.choose('surface', 'lines'),
    KeyM: () => byId('outlines').click(),
    KeyO: () => actions.choose('mode', 'orbit'),
    KeyF: () => actions.choose('mode', 'walk'),
    KeyR: actions.goToCamera,
    KeyH: actions.help,
    Escape: () => panel.pick(null),
  };
  addEventListener('keydown', event => {
    stage.setFast(event.shiftKey);
    // What these do with a key is theirs.
    const taken = event.target.closest(event.code === 'Space' ? 'select, dialog, button, input' : 'select, dialog');
    if (!keys[event.code] || taken || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.code]();
  });
  addEventListener('keyup', event => stage.setFast(event.shiftKey));
}

// A press that ends where it began picks.
function bindPicking(canvas, data, panel, stage) {
  const pick = makePicker(data);
  let pressed = null;
  canvas.addEventListener('pointerdown', event => pressed = event.button === 0 ? [event.clientX, event.clientY] : null);
  canvas.addEventListener('pointerup', event => {
    if (pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < clickPixels)
      panel.pick(pick(stage.ray(event.clientX, event.clientY)));
    pressed = null;
  });
}

function start(data) {
  const stage = makeStage(byId('view')), mesh = makeMesh(data);
  stage.scene.add(mesh.group);
  // What a patch sees has no lines on it.
  const withPlainMesh = look => {
    mesh.setOutlines(false);
    if (chosen('surface') === 'lines') mesh.setStyle('smooth');
    look();
    mesh.setOutlines(byId('outlines').checked);
    mesh.setStyle(chosen('surface'));
  };
  describe(data);
  const panel = makePanel(data, mesh, stage, withPlainMesh);
  const actions = makeActions(data, mesh, stage, panel);
  bindControls(actions, panel);
  bindKeys(actions, panel, stage);
  bindPicking(byId('view'), data, panel, stage);
  stage.goTo(data.header.cameras[0]);
  actions.showSurface();
  actions.showExposure();
  actions.showPass(data.light.length - 1);
  stage.renderer.render(stage.scene, stage.camera);
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
