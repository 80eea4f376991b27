// A ray -> the patch that it meets first, from its lit side.
import * as THREE from 'three';

function makeBoxes(data) {
  const boxes = [];
  for (let polygon = 0; polygon + 1 < data.polygonPatch.length; ++polygon) {
    const box = new THREE.Box3();
    const first = data.outlineFirst[data.polygonPatch[polygon]];
    const last = data.outlineFirst[data.polygonPatch[polygon + 1]];
    const point = new THREE.Vector3();
    for (let k = first; k < last; ++k) box.expandByPoint(point.fromArray(data.position, 3 * data.outline[k]));
    // Flat boxes are missed by rounding.
    boxes.push(box.expandByScalar(1e-5));
  }
  return boxes;
}

// Returns ray => {patch, polygon, point, normal} or null. Polygons by their boxes, then fan by fan.
export function makePicker(data) {
  const boxes = makeBoxes(data);
  const a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3(), hit = new THREE.Vector3();
  const at = (vector, k) => vector.fromArray(data.position, 3 * data.outline[k]);
  return ray => {
    let best = null, nearest = Infinity;
    boxes.forEach((box, polygon) => {
      if (!ray.intersectsBox(box)) return;
      for (let patch = data.polygonPatch[polygon]; patch < data.polygonPatch[polygon + 1]; ++patch) {
        const first = data.outlineFirst[patch], last = data.outlineFirst[patch + 1];
        at(a, first);
        for (let k = first + 1; k + 1 < last; ++k) {
          if (!ray.intersectTriangle(a, at(b, k), at(c, k + 1), true, hit)) continue;
          const distance = hit.distanceToSquared(ray.origin);
          if (distance >= nearest) continue;
          nearest = distance;
          const normal = new THREE.Vector3().crossVectors(b.clone().sub(a), c.clone().sub(a)).normalize();
          best = {patch, polygon, point: hit.clone(), normal};
        }
      }
    });
    return best;
  };
}
