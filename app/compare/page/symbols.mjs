// The plots' point shapes as paths, for legends beside text.
import {
  symbolCircle, symbolCross, symbolDiamond, symbolSquare, symbolStar, symbolTriangle, symbolWye,
} from 'd3-shape';

const kShapes = {
  circle: symbolCircle, square: symbolSquare, triangle: symbolTriangle, diamond: symbolDiamond, star: symbolStar,
  cross: symbolCross, wye: symbolWye,
};

// The outline of a shape with the area of a circle of radius r. The hexagon is the plot library's own.
export function symbolPath(name, r) {
  const shape = kShapes[name];
  const parts = [];
  const context = {
    moveTo: (x, y) => parts.push(`M${x},${y}`),
    lineTo: (x, y) => parts.push(`L${x},${y}`),
    closePath: () => parts.push('Z'),
    rect: (x, y, w, h) => parts.push(`M${x},${y}h${w}v${h}h${-w}Z`),
    arc: (x, y, radius) => parts.push(`M${x - radius},${y}a${radius},${radius} 0 1 0 ${2 * radius},0` +
      `a${radius},${radius} 0 1 0 ${-2 * radius},0Z`),
  };
  if (shape) {
    shape.draw(context, Math.PI * r * r);
  } else {
    const corner = r * Math.sqrt(2 * Math.PI / (3 * Math.sqrt(3)));
    for (let k = 0; k < 6; k++) {
      context[k === 0 ? 'moveTo' : 'lineTo'](corner * Math.sin(k * Math.PI / 3), corner * Math.cos(k * Math.PI / 3));
    }
    context.closePath();
  }
  return parts.join('');
}
