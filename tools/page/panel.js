// The patch that was clicked -> its numbers, its growth, what it sees, and a frame around it in the picture.
import * as THREE from 'three';
import {unpackLight} from './data.js';
import {makeFisheye} from './fisheye.js';

const byId = id => document.getElementById(id);

// Five digits, and no more zeros than say something.
function format(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(3) : String(Number(value.toPrecision(5)));
}

// The unit of power in which the largest of some watts has a digit before the point.
const powerUnits = [['GW', 1e9], ['MW', 1e6], ['kW', 1e3], ['W', 1], ['mW', 1e-3], ['µW', 1e-6], ['nW', 1e-9]];
const pickPowerUnit = watts => powerUnits.find(([, size]) => watts >= size) ?? powerUnits[watts > 0 ? 6 : 3];

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

// A bar a recorded pass; the shown one is bright, later ones are dim.
function drawGrowth(values, shown) {
  const canvas = byId('growth'), pen = canvas.getContext('2d'), {width, height} = canvas;
  const most = Math.max(...values), step = width / values.length;
  pen.clearRect(0, 0, width, height);
  values.forEach((value, index) => {
    const tall = most > 0 ? (height - 4) * value / most : 0;
    pen.fillStyle = index === shown ? '#f4b860' : index < shown ? '#a98a55' : '#4a4740';
    pen.fillRect(index * step + 2, height - tall - 2, step - 4, tall + 2);
  });
}

// The numbers of a patch, as the tables show them.
function makeNumbers(data) {
  const {header, light} = data, last = light.length - 1;
  const triple = (column, row) => [0, 1, 2].map(k => column[3 * row + k]);
  const area = patch => data.area[patch] * header.units_per_length ** 2;
  const squareMetres = patch => area(patch) * header.metres_per_unit ** 2 * data.exposed[patch];
  return {
    area,
    // W/m2. Passes before the last are kept in nine bits a channel: three digits.
    radiosity: (patch, index) =>
      index === last
        ? triple(data.radiosity, patch)
        : unpackLight(light[index].patch[patch]).map(value => Number((value / 2 ** header.exposure).toPrecision(3))),
    // W, after the last pass.
    received: patch => triple(data.irradiance, patch).map(value => value * squareMetres(patch)),
    sent: patch => triple(data.radiosity, patch).map(value => value * squareMetres(patch)),
  };
}

// {pick(picked or null), show(pass index)}: picked as pick.js has it. withPlainMesh(look) calls look() while the mesh is
// drawn without lines.
export function makePanel(data, mesh, stage, withPlainMesh) {
  const {header, polygons, light} = data, numbers = makeNumbers(data), fisheye = makeFisheye(stage.renderer);
  const frame = new THREE.LineLoop(
    new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: 0x6fe3ff, depthTest: false, toneMapped: false}));
  frame.frustumCulled = false;
  stage.scene.add(frame);
  let picked = null, index = 0;

  const describe = () => {
    const {patch, polygon, point} = picked;
    const place = point.toArray().map((value, k) => header.origin[k] + value * header.units_per_length);
    byId('panel').dataset.patch = patch;
    byId('polygon').textContent = polygons.id[polygon];
    byId('place').textContent =
      `patch ${patch}, level ${data.level[patch]}, area ${format(numbers.area(patch))} ${header.units}²\nat ` +
      place.map(value => Number(value.toFixed(2)) || 0).join(', ');
  };

  const tell = () => {
    const {patch, polygon} = picked, reflectance = polygons.reflectance[polygon];
    const last = light.length - 1, name = at => `Radiosity, ${header.step} ${light[at].pass}`;
    fillTable('light-table', [
      {name: 'Emission', values: polygons.emission[polygon]},
      {name: 'Reflectance', values: reflectance},
      ...(index === last ? [] : [{name: name(index), values: numbers.radiosity(patch, index), now: true}]),
      {name: name(last), values: numbers.radiosity(patch, last), now: index === last},
    ]);
    const sent = numbers.sent(patch), received = numbers.received(patch);
    const [unit, size] = pickPowerUnit(Math.max(...sent, ...received));
    byId('power-unit').textContent = `${unit}, ${header.step} ${light[last].pass}`;
    fillTable('power-table', [
      {name: 'Received', values: received.map(value => value / size)},
      {name: 'Absorbed', values: received.map((value, k) => value * (1 - reflectance[k]) / size)},
      {name: 'Sent', values: sent.map(value => value / size)},
    ]);
    drawGrowth(light.map((_, at) => Math.max(...numbers.radiosity(patch, at))), index);
  };

  const look = () => {
    // Upwards on walls; on floors and ceilings away from who looks at them.
    const up = stage.camera.up.clone();
    if (Math.abs(up.dot(picked.normal)) > 0.9) stage.camera.getWorldDirection(up);
    withPlainMesh(() => fisheye.draw(byId('fisheye'), mesh.group, picked, up, byId('by-share').checked));
  };

  const update = () => {
    byId('panel').hidden = !picked;
    document.body.classList.toggle('picked', Boolean(picked));
    frame.visible = Boolean(picked);
    if (picked) {
      describe();
      tell();
      look();
    }
    stage.redraw();
  };
  byId('by-share').addEventListener('change', update);

  return {
    pick(next) {
      picked = next;
      if (picked) {
        const corners = [];
        for (let k = data.outlineFirst[picked.patch]; k < data.outlineFirst[picked.patch + 1]; ++k)
          corners.push(new THREE.Vector3().fromArray(data.position, 3 * data.outline[k]));
        frame.geometry.dispose();
        frame.geometry = new THREE.BufferGeometry().setFromPoints(corners);
      }
      update();
    },
    // After another pass or exposure.
    show(passIndex) {
      index = passIndex;
      update();
    },
  };
}
