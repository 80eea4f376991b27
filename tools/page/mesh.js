// Columns -> what three.js draws: a smooth surface, a flat one, and the outlines of patches. All three read their
// light from textures of shared-exponent words, so that another pass is one upload and no new geometry.
import * as THREE from 'three';

const textureWidth = 2048;

const vertexShader = `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform highp sampler2D light;
uniform float gain;
in vec3 position;
#ifdef ROWS
in float row;
#endif
#ifdef LINES
in vec3 normal;
#endif
out vec3 shown;
void main() {
#ifdef ROWS
  int at = int(row);
#else
  int at = gl_VertexID;
#endif
  // Clipped at the corners and not between them, as the program's pictures are.
  shown = clamp(gain * texelFetch(light, ivec2(at % ${textureWidth}, at / ${textureWidth}), 0).rgb, 0.0, 1.0);
  vec4 place = modelViewMatrix * vec4(position, 1.0);
#ifdef LINES
  // Out of sight with the lit side.
  if (dot(place.xyz, mat3(modelViewMatrix) * normal) >= 0.0) place.xyz = vec3(0.0);
#endif
#ifdef SEAMS
  // A hair further away, on the same ray: surfaces hide seams.
  place.xyz *= 1.005;
#endif
  gl_Position = projectionMatrix * place;
}`;

const fragmentShader = `
precision highp float;
uniform vec4 tint;
in vec3 shown;
out vec4 color;
vec3 encode(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
void main() {
  // A dither below one level hides bands on smooth walls (Jimenez: Next Generation Post Processing in Call of Duty,
  // 2014: interleaved gradient noise).
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  color = vec4(mix(encode(shown), tint.rgb, tint.a) + (noise - 0.5) / 255.0, 1.0);
}`;

function makeMaterial(texture, defines, settings) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader,
    fragmentShader,
    defines,
    uniforms: {light: {value: texture}, gain: {value: 1}, tint: {value: new THREE.Vector4(0, 0, 0, 0)}},
    ...settings,
  });
}

function makeTexture(count) {
  const height = Math.max(1, Math.ceil(count / textureWidth));
  const texture = new THREE.DataTexture(
    new Uint32Array(textureWidth * height), textureWidth, height, THREE.RGBFormat, THREE.UnsignedInt5999Type);
  texture.minFilter = texture.magFilter = THREE.NearestFilter;
  texture.generateMipmaps = false;
  return texture;
}

function fill(texture, words) {
  texture.image.data.set(words);
  texture.needsUpdate = true;
}

// Calls visit(patch, a, b, c) with the vertices of every triangle: the fans of all outlines.
export function forTriangles({outline, outlineFirst}, visit) {
  for (let patch = 0; patch + 1 < outlineFirst.length; ++patch)
    for (let first = outlineFirst[patch], k = first + 1; k + 1 < outlineFirst[patch + 1]; ++k)
      visit(patch, outline[first], outline[k], outline[k + 1]);
}

function makeSmooth(data, position) {
  const index = new Uint32Array(3 * (data.outline.length - 2 * data.level.length));
  let at = 0;
  forTriangles(data, (patch, a, b, c) => {
    index[at++] = a;
    index[at++] = b;
    index[at++] = c;
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', position);
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

// Corners of one place in different patches have different light: nothing is shared.
function makeFlat(data) {
  const count = 3 * (data.outline.length - 2 * data.level.length);
  const position = new Float32Array(3 * count), row = new Float32Array(count);
  let at = 0;
  forTriangles(data, (patch, a, b, c) => {
    for (const vertex of [a, b, c]) {
      position[3 * at] = data.position[3 * vertex];
      position[3 * at + 1] = data.position[3 * vertex + 1];
      position[3 * at + 2] = data.position[3 * vertex + 2];
      row[at++] = patch;
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
  geometry.setAttribute('row', new THREE.BufferAttribute(row, 1));
  return geometry;
}

// All edges of outlines, sorted, as (lesser vertex) * vertices + (greater): inner ones twice, for two patches run
// them in opposite directions; those on the border of a polygon once.
function findEdges(data) {
  const edges = new Float64Array(data.outline.length), vertexCount = data.position.length / 3;
  for (let patch = 0; patch < data.level.length; ++patch) {
    const first = data.outlineFirst[patch], last = data.outlineFirst[patch + 1];
    for (let k = first; k < last; ++k) {
      const a = data.outline[k], b = data.outline[k + 1 < last ? k + 1 : first];
      edges[k] = Math.min(a, b) * vertexCount + Math.max(a, b);
    }
  }
  return edges.sort();
}

// Three numbers a vertex: the lit side of its polygon.
function findNormals(data) {
  const normals = new Float32Array(data.position.length);
  const corner = k => new THREE.Vector3().fromArray(data.position, 3 * data.outline[k]);
  for (let polygon = 0; polygon + 1 < data.polygonPatch.length; ++polygon) {
    const first = data.outlineFirst[data.polygonPatch[polygon]];
    const normal = corner(first + 1).sub(corner(first)).cross(corner(first + 2).sub(corner(first))).normalize();
    for (let k = first; k < data.outlineFirst[data.polygonPatch[polygon + 1]]; ++k)
      normal.toArray(normals, 3 * data.outline[k]);
  }
  return normals;
}

function makeLines(data, position) {
  const vertexCount = data.position.length / 3, index = [];
  findEdges(data).forEach((edge, k, edges) => {
    if (k === 0 || edge !== edges[k - 1]) index.push(Math.floor(edge / vertexCount), edge % vertexCount);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', position);
  geometry.setAttribute('normal', new THREE.BufferAttribute(findNormals(data), 3));
  geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(index), 1));
  return geometry;
}

// The borders of all polygons. Neighbouring polygons are cut each by its own light, and between them pixels
// may belong to neither: a line behind the border fills them.
function makeSeams(data) {
  const vertexCount = data.position.length / 3, normals = findNormals(data), position = [], row = [], normal = [];
  findEdges(data).forEach((edge, k, edges) => {
    if (edge === edges[k - 1] || edge === edges[k + 1]) return;
    for (const vertex of [Math.floor(edge / vertexCount), edge % vertexCount]) {
      position.push(...data.position.subarray(3 * vertex, 3 * vertex + 3));
      normal.push(...normals.subarray(3 * vertex, 3 * vertex + 3));
      row.push(vertex);
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normal, 3));
  geometry.setAttribute('row', new THREE.Float32BufferAttribute(row, 1));
  return geometry;
}

// {group, show(pass index), setGain(gain), setStyle('smooth' | 'flat' | 'lines'), setOutlines(on)}. What is not shown
// at first is made when it is asked for.
export function makeMesh(data) {
  const position = new THREE.BufferAttribute(data.position, 3);
  const light = {vertex: makeTexture(data.position.length / 3), patch: makeTexture(data.level.length)};
  const behind = {polygonOffsetFactor: 1, polygonOffsetUnits: 1};
  const makers = {
    smooth: () => new THREE.Mesh(makeSmooth(data, position), makeMaterial(light.vertex, {}, behind)),
    flat: () => new THREE.Mesh(makeFlat(data), makeMaterial(light.patch, {ROWS: ''}, behind)),
    lines: () => new THREE.LineSegments(makeLines(data, position), makeMaterial(light.vertex, {LINES: ''}, {})),
    seams: () => new THREE.LineSegments(makeSeams(data), makeMaterial(light.vertex, {ROWS: '', LINES: '', SEAMS: ''}, {})),
  };
  const group = new THREE.Group(), made = {};
  let style = 'smooth', outlines = false, gain = 1;
  const update = () => {
    const shown = style === 'lines' ? ['lines'] : [style, 'seams', ...(outlines ? ['lines'] : [])];
    for (const name of shown)
      if (!made[name]) {
        made[name] = makers[name]();
        made[name].frustumCulled = false;
        group.add(made[name]);
      }
    for (const [name, object] of Object.entries(made)) {
      object.visible = shown.includes(name);
      object.material.uniforms.gain.value = gain;
      // Only where lines lie on them: it puts the edges of slanted surfaces behind their seams.
      object.material.polygonOffset = outlines;
    }
    // Over a surface, lines are a shade; alone they are the light.
    made.lines?.material.uniforms.tint.value.set(0.3, 0.34, 0.4, style === 'lines' ? 0 : 0.4);
  };
  update();
  return {
    group,
    show(index) {
      fill(light.vertex, data.light[index].vertex);
      fill(light.patch, data.light[index].patch);
    },
    setGain(value) {
      gain = value;
      update();
    },
    setStyle(name) {
      style = name;
      update();
    },
    setOutlines(on) {
      outlines = on;
      update();
    },
  };
}
