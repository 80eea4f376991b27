// The canvas, its camera and what is drawn: only when something has changed.
import * as THREE from 'three';
import {makeMover} from './move.js';

// {renderer, scene, camera, redraw(), setFast(on), setMode('orbit' | 'walk'), goTo(view), ray(x, y)}; views as the header
// has them.
export function makeStage(canvas) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, powerPreference: 'high-performance'});
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x0d0e10);
  // Scenes have an area of 1: a room is about 0.4 high.
  const camera = new THREE.PerspectiveCamera(60, 1, 1e-3, 200);
  let view = null, fast = false, asked = false, last = 0;

  const redraw = () => {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  };
  const mover = makeMover(camera, canvas, redraw);
  function draw(now) {
    asked = false;
    if (mover.step((now - last) / 1000, fast)) redraw();
    last = now;
    renderer.render(scene, camera);
  }

  const resize = () => {
    renderer.setSize(innerWidth, innerHeight, false);
    camera.aspect = innerWidth / innerHeight;
    // A window narrower than the scene's picture shows as much from left to right.
    const half = Math.tan(THREE.MathUtils.degToRad(view.fov / 2)) * Math.max(1, view.aspect / camera.aspect);
    camera.fov = THREE.MathUtils.radToDeg(2 * Math.atan(half));
    camera.updateProjectionMatrix();
    redraw();
  };
  addEventListener('resize', resize);

  return {
    renderer,
    scene,
    camera,
    redraw,
    setFast(on) {
      fast = on;
    },
    setMode: mover.setMode,
    goTo(next) {
      view = next;
      mover.start(view);
      resize();
    },
    // What lies under a point of the window.
    ray(x, y) {
      const caster = new THREE.Raycaster();
      caster.setFromCamera(new THREE.Vector2(2 * x / innerWidth - 1, 1 - 2 * y / innerHeight), camera);
      return caster.ray;
    },
  };
}
