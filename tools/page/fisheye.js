// A point of a patch -> what it sees: the hemisphere before it, from a cube map.
import * as THREE from 'three';

const vertexShader = `
in vec3 position;
out vec2 place;
void main() {
  place = position.xy;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

const fragmentShader = `
precision highp float;
uniform samplerCube sky;
uniform vec3 right, up, ahead;
uniform bool byShare;
in vec2 place;
out vec4 color;
void main() {
  float r = length(place);
  if (r > 1.0) {
    color = vec4(0.0);
    return;
  }
  // Radius by angle; or by its sine, where equal areas send equal shares of light (Nusselt's analogue, 1928).
  float sine = byShare ? r : sin(1.5707963 * r);
  vec2 around = r > 0.0 ? place / r : vec2(0.0);
  color = texture(sky, sine * (around.x * right + around.y * up) + sqrt(max(0.0, 1.0 - sine * sine)) * ahead);
}`;

const facePixels = 512;

// {draw(canvas, group, {point, normal}, up, byShare)}: fills a square canvas.
export function makeFisheye(renderer) {
  const cube = new THREE.WebGLCubeRenderTarget(facePixels);
  // Lengths are such that a scene's area is 1: a start of the view far below any patch.
  const eye = new THREE.CubeCamera(2e-4, 1e3, cube);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0);
  const uniforms = {
    sky: {value: cube.texture},
    right: {value: new THREE.Vector3()},
    up: {value: new THREE.Vector3()},
    ahead: {value: new THREE.Vector3()},
    byShare: {value: false},
  };
  const disc = new THREE.Mesh(
    new THREE.PlaneGeometry(2, 2),
    new THREE.RawShaderMaterial({glslVersion: THREE.GLSL3, vertexShader, fragmentShader, uniforms}));
  disc.frustumCulled = false;
  const discScene = new THREE.Scene().add(disc);
  const camera = new THREE.Camera();
  return {
    draw(canvas, group, {point, normal}, up, byShare) {
      const parent = group.parent;
      scene.add(group);
      eye.position.copy(point).addScaledVector(normal, 1e-3);
      eye.update(renderer, scene);
      parent.add(group);

      uniforms.ahead.value.copy(normal);
      uniforms.up.value.copy(up).addScaledVector(normal, -up.dot(normal)).normalize();
      uniforms.right.value.crossVectors(normal, uniforms.up.value);
      uniforms.byShare.value = byShare;
      const size = canvas.width;
      const target = new THREE.WebGLRenderTarget(size, size);
      renderer.setRenderTarget(target);
      renderer.render(discScene, camera);
      const pixels = new Uint8Array(4 * size * size);
      renderer.readRenderTargetPixels(target, 0, 0, size, size, pixels);
      renderer.setRenderTarget(null);
      target.dispose();
      const image = new ImageData(size, size);
      // Rows of the graphics card run upwards.
      for (let y = 0; y < size; ++y)
        image.data.set(pixels.subarray(4 * size * (size - 1 - y), 4 * size * (size - y)), 4 * size * y);
      canvas.getContext('2d', {willReadFrequently: true}).putImageData(image, 0, 0);
    },
  };
}
