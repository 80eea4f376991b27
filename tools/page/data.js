// The page's blocks of data -> typed arrays. README.md describes them.

const header = () => JSON.parse(document.getElementById('patchlight').textContent);

// The bytes of one block: base64 of zlib's format. Its element goes, so that the text need not stay in memory.
async function unpack(name) {
  const element = document.getElementById(name);
  const text = atob(element.textContent);
  element.remove();
  const packed = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) packed[k] = text.charCodeAt(k);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Words of 32 bits from four planes of bytes.
function joinPlanes(bytes, count) {
  const words = new Uint32Array(count);
  for (let k = 0; k < count; ++k)
    words[k] = bytes[k] | bytes[k + count] << 8 | bytes[k + 2 * count] << 16 | bytes[k + 3 * count] << 24;
  return words;
}

// Each word was stored less the one `delta` before it.
function addUp(words, delta) {
  for (let k = delta; k < words.length; ++k) words[k] += words[k - delta];
  return words;
}

// The four fields of two shared-exponent words added, each by itself.
const addFields = (a, b) =>
  (a & 0x1ff) + (b & 0x1ff) & 0x1ff | (a & 0x3fe00) + (b & 0x3fe00) & 0x3fe00 |
  (a & 0x7fc0000) + (b & 0x7fc0000) & 0x7fc0000 | (a & 0xf8000000) + (b & 0xf8000000) & 0xf8000000;

// Light was stored less that of the pass before, or less the row before.
function addLight(words, base) {
  for (let k = 0, last = 0; k < words.length; ++k) words[k] = last = addFields(words[k], base ? base[k] : last);
  return words;
}

// Everything in the page: {header, polygons, ...}, a column a name of README.md, and `light`: one entry a recorded
// pass with its number and the words of vertices and patches.
export async function load() {
  const about = header();
  if (about.format !== 'patchlight-page' || about.version !== 1)
    throw new Error(`this viewer reads version 1 of patchlight-page, and the data is ${about.format} ${about.version}`);
  const bytes = await Promise.all(about.blocks.map(block => unpack(block.name)));
  const columns = {};
  about.blocks.forEach((block, k) => {
    if (block.type === 'json') columns[block.name] = JSON.parse(new TextDecoder().decode(bytes[k]));
    if (block.type === 'uint8') columns[block.name] = bytes[k];
    if (block.type === 'uint32') columns[block.name] = addUp(joinPlanes(bytes[k], block.count), block.delta);
    if (block.type === 'float32')
      columns[block.name] = new Float32Array(addUp(joinPlanes(bytes[k], block.count), block.delta).buffer);
    if (block.type === 'rgb9e5')
      columns[block.name] = addLight(joinPlanes(bytes[k], block.count), columns[block.base]);
    bytes[k] = null;
  });
  const outlineFirst = new Uint32Array(columns['outline-count'].length + 1);
  columns['outline-count'].forEach((count, k) => outlineFirst[k + 1] = outlineFirst[k] + count);
  return {
    header: about,
    polygons: columns.polygons,
    position: columns.position,
    outline: columns.outline,
    outlineFirst,
    polygonPatch: columns['polygon-patch'],
    level: columns.level,
    area: columns.area,
    exposed: columns.exposed,
    radiosity: columns.radiosity,
    irradiance: columns.irradiance,
    light: about.passes.map(pass => ({pass, vertex: columns[`vertex-${pass}`], patch: columns[`patch-${pass}`]})),
  };
}

// A shared-exponent word as three numbers.
export function unpackLight(word) {
  const step = 2 ** ((word >>> 27) - 24);
  return [(word & 511) * step, (word >>> 9 & 511) * step, (word >>> 18 & 511) * step];
}
