// The little tripod in the corner of the picture: which way x, y and z point.

import { PerspectiveCamera, Vector3 } from 'three';

const colours = { x: ['#b3352c', '#f08379'], y: ['#1d7a46', '#57c288'], z: ['#2f6db3', '#6ea8e6'] } as const;

/** Draws into a square of `size` CSS pixels at (left, top) of the context. A flat shape seen from above needs no z. */
export function drawAxes(context: CanvasRenderingContext2D, camera: PerspectiveCamera, left: number, top: number, size: number, dark: boolean, flat: boolean): void {
  const centre = size / 2, length = Math.max(20, size * 0.34 - 4);
  const arms = (['x', 'y', 'z'] as const)
    .map((name, k) => ({ name, d: new Vector3(k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0).applyQuaternion(camera.quaternion.clone().invert()) }))
    .filter(({ name, d }) => !(flat && name === 'z' && d.z > 0.999));
  arms.sort((a, b) => a.d.z - b.d.z);
  context.lineCap = 'round';
  context.font = '600 11px system-ui, "Segoe UI", Arial, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  for (const { name, d } of arms) {
    const paint = colours[name][dark ? 1 : 0];
    context.globalAlpha = d.z < -0.2 ? 0.55 : 1;
    context.strokeStyle = paint;
    context.fillStyle = paint;
    context.lineWidth = 1.8;
    const x = left + centre + length * d.x, y = top + centre - length * d.y;
    context.beginPath();
    context.moveTo(left + centre, top + centre);
    context.lineTo(x, y);
    context.stroke();
    if (Math.hypot(d.x, d.y) > 0.2) context.fillText(name, x + (9 * d.x) / Math.max(0.3, Math.hypot(d.x, d.y)), y - (9 * d.y) / Math.max(0.3, Math.hypot(d.x, d.y)));
  }
  context.globalAlpha = 1;
  context.textAlign = 'left';
}
