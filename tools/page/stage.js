// The canvas, its camera and what is drawn: only when something has changed. Where frames take long, as without a
// graphics card, pictures are coarser while the camera moves.
import * as THREE from 'three';
import {makeMover} from './move.js';

const quickMilliseconds = 40, shareLeast = 0.5, restMilliseconds = 250, framesAMeasurement = 8;

// {renderer, scene, camera, redraw(), setFast(on), setMode('orbit' | 'walk'), goTo(view), ray(x, y)}; views as the header
// has them.
export function makeStage(canvas) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, powerPreference: 'high-performance'});
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x0d0e10);
  // Scenes have an area of 1: a room is about 0.4 high.
  const camera = new THREE.PerspectiveCamera(60, 1, 1e-3, 200);
  let view = null, fast = false, asked = false, last = 0;
  // How many pixels a moving picture has each way, of those of one that stands; and moving frames since that was found.
  let moving = false, share = 1, frames = 0, resting = 0;

  const setPixels = () => renderer.setPixelRatio(Math.min(devicePixelRatio, 2) * (moving ? share : 1));
  const redraw = () => {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  };
  const render = () => renderer.render(scene, camera);

  const setMoving = on => {
    moving = on;
    frames = last = 0;
    canvas.classList.toggle('moving', on);
    if (share < 1) {
      setPixels();
      render();
    }
  };
  const rest = () => {
    if (asked) resting = setTimeout(rest, restMilliseconds);
    else setMoving(false);
  };
  const moved = () => {
    if (!moving) setMoving(true);
    clearTimeout(resting);
    resting = setTimeout(rest, restMilliseconds);
    redraw();
  };
  // Draws, waits until it is done, and picks the share by how long that took.
  const measure = () => {
    const gl = renderer.getContext(), began = performance.now();
    render();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    const better = share * Math.sqrt(quickMilliseconds / (performance.now() - began));
    const next = Math.max(shareLeast, Math.min(1, better));
    if (Math.abs(next - share) < 0.1) return;
    share = next;
    setPixels();
    render();
  };
  const mover = makeMover(camera, canvas, moved);
  function draw(now) {
    asked = false;
    if (mover.step(last ? (now - last) / 1000 : 0, fast)) moved();
    last = now;
    if (moving && frames++ % framesAMeasurement === 0) measure();
    else render();
  }

  const resize = () => {
    setPixels();
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
