// Keys and pointer -> where the camera is: orbit round a point, or walk and look about.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const lengthsPerSecond = 0.25, radiansPerPixel = 0.003;
const keys = {
  KeyW: [0, 0, 1], ArrowUp: [0, 0, 1], KeyS: [0, 0, -1], ArrowDown: [0, 0, -1],
  KeyA: [-1, 0, 0], ArrowLeft: [-1, 0, 0], KeyD: [1, 0, 0], ArrowRight: [1, 0, 0],
  KeyE: [0, 1, 0], KeyQ: [0, -1, 0],
};

// {start(view), setMode('orbit' | 'walk'), step(seconds, fast) -> true while it moves}. Calls changed() when somebody moves
// the camera.
export function makeMover(camera, element, changed) {
  let orbit = null, mode = 'orbit';
  const held = new Set();

  const forward = new THREE.Vector3(), side = new THREE.Vector3(), move = new THREE.Vector3();
  const findAxes = () => {
    camera.getWorldDirection(forward);
    side.crossVectors(forward, camera.up).normalize();
  };

  const look = (dx, dy) => {
    findAxes();
    const pitch = Math.asin(THREE.MathUtils.clamp(forward.dot(camera.up), -1, 1));
    const turned = THREE.MathUtils.clamp(pitch - dy * radiansPerPixel, -1.5, 1.5) - pitch;
    forward.applyAxisAngle(side, turned).applyAxisAngle(camera.up, -dx * radiansPerPixel);
    camera.lookAt(move.copy(camera.position).add(forward));
    changed();
  };

  element.addEventListener('pointermove', event => {
    if (mode === 'walk' && event.buttons & 1) look(event.movementX, event.movementY);
  });
  element.addEventListener('pointerdown', event => {
    if (mode === 'walk') element.setPointerCapture(event.pointerId);
  });
  addEventListener('keydown', event => {
    const taken = event.target.closest(event.code.startsWith('Arrow') ? 'select, dialog, input' : 'select, dialog');
    if (!keys[event.code] || taken || event.ctrlKey || event.metaKey || event.altKey) return;
    held.add(event.code);
    event.preventDefault();
    changed();
  });
  addEventListener('keyup', event => held.delete(event.code));
  addEventListener('blur', () => held.clear());

  // The orbit goes on round what the middle of the picture shows, at the distance that it had.
  const aimOrbit = distance => {
    camera.getWorldDirection(forward);
    orbit.target.copy(camera.position).addScaledVector(forward, distance);
  };

  return {
    start(view) {
      camera.up.fromArray(view.up).normalize();
      camera.position.fromArray(view.eye);
      // It asks for the camera's upward axis when it is made, and never again.
      orbit?.dispose();
      orbit = new OrbitControls(camera, element);
      orbit.minDistance = 1e-3;
      orbit.maxDistance = 100;
      orbit.enabled = mode === 'orbit';
      orbit.target.fromArray(view.target);
      camera.lookAt(orbit.target);
      orbit.update();
      orbit.addEventListener('change', changed);
    },
    setMode(name) {
      if (name === mode) return;
      const distance = orbit.target.distanceTo(camera.position);
      mode = name;
      orbit.enabled = mode === 'orbit';
      if (orbit.enabled) aimOrbit(distance);
    },
    step(seconds, fast) {
      if (held.size === 0) return false;
      findAxes();
      move.set(0, 0, 0);
      for (const code of held) {
        const [right, up, ahead] = keys[code];
        move.addScaledVector(side, right).addScaledVector(camera.up, up).addScaledVector(forward, ahead);
      }
      move.multiplyScalar(lengthsPerSecond * Math.min(seconds, 0.1) * (fast ? 4 : 1));
      camera.position.add(move);
      orbit.target.add(move);
      return true;
    },
  };
}
