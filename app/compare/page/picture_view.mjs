// Two pictures in one frame, parted by a divider that can be moved, with zoom and pan.
//
// Everything is in device pixels: at 1×, 2×, … a pixel of the picture covers the same whole number of them everywhere.
import {element, svgElement} from './dom.mjs';

export const kZooms = [1, 2, 4, 8, 16];
const kFit = 'fit';
const kReach = 18;  // CSS pixels beside the divider that still take hold of it
const kLargestEnlarged = 2 ** 24;  // pixels

// A picture enlarged by a whole factor. Scaled down from this to a broken factor, pixels stay sharp and equally large.
function enlarged(canvas, factor) {
  const large = document.createElement('canvas');
  large.width = canvas.width * factor;
  large.height = canvas.height * factor;
  const context = large.getContext('2d');
  context.imageSmoothingEnabled = false;
  context.drawImage(canvas, 0, 0, large.width, large.height);
  return large;
}

function grip() {
  return svgElement('svg', {class: 'grip', viewBox: '-18 -18 36 36', width: 36, height: 36, 'aria-hidden': 'true'},
    svgElement('circle', {r: 16}),
    svgElement('path', {d: 'M-5,-5L-10,0L-5,5M5,-5L10,0L5,5'}));
}

export class PictureView {
  // `hear` has: moved(share) of the divider, pointed(x, y) or pointed(null), zoomed(zoom).
  constructor(width, height, hear) {
    this.size = {width, height};
    this.hear = hear;
    this.zoom = kFit;
    this.center = {x: width / 2, y: height / 2};
    this.share = 0.5;
    this.ratio = 1;  // device pixels of a CSS pixel
    this.sides = [null, null];
    this.pointer = null;  // where the mouse is, in the window
    this.enlarged = new WeakMap();
    this.canvas = element('canvas', {class: 'view-canvas', role: 'img',
      'aria-label': 'Two pictures, parted by the divider'});
    this.divider = element('div', {class: 'divider', role: 'slider', tabindex: 0, 'aria-orientation': 'horizontal',
      'aria-label': 'Divider between left and right picture', 'aria-valuemin': 0, 'aria-valuemax': 100}, grip());
    this.frame = element('div', {class: 'frame', tabindex: 0, role: 'group', style: `--aspect:${width / height}`,
      'aria-label': 'Pictures: arrow keys move the view when it is zoomed, plus and minus zoom, 0 fits'},
    this.canvas, this.divider);
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.frame);
    this.setShare(this.share);
  }

  setSides(left, right) {
    this.sides = [left, right];
    this.draw();
  }

  setShare(share) {
    this.share = Math.min(1, Math.max(0, share));
    const percent = Math.round(100 * this.share);
    this.divider.style.left = `${100 * this.share}%`;
    this.divider.setAttribute('aria-valuenow', percent);
    this.divider.setAttribute('aria-valuetext', `${percent} % left picture, ${100 - percent} % right picture`);
    this.hear.moved(this.share);
    this.draw();
  }

  resize() {
    this.ratio = window.devicePixelRatio || 1;
    const width = Math.round(this.frame.clientWidth * this.ratio);
    const height = Math.round(this.frame.clientHeight * this.ratio);
    if (width === this.canvas.width && height === this.canvas.height) return;
    this.canvas.width = width;
    this.canvas.height = height;
    // Not 100 % of a frame that may end within a pixel: then the browser would resample what is drawn here.
    this.canvas.style.width = `${width / this.ratio}px`;
    this.canvas.style.height = `${height / this.ratio}px`;
    this.settle();
    this.draw();
  }

  scaleOf(zoom) {
    if (zoom !== kFit) return zoom * Math.max(1, Math.round(this.ratio));
    return Math.min(this.canvas.width / this.size.width, this.canvas.height / this.size.height);
  }

  // Scale and the place of the picture's corner in the canvas.
  geometry() {
    const scale = this.scaleOf(this.zoom);
    const corner = (room, center) => Math.round(room / 2 - center * scale);
    return {scale, x: corner(this.canvas.width, this.center.x),
      y: corner(this.canvas.height, this.center.y)};
  }

  canPan() {
    const scale = this.scaleOf(this.zoom);
    return this.size.width * scale > this.canvas.width + 1 || this.size.height * scale > this.canvas.height + 1;
  }

  // A point of the window in pixels of the canvas, which browsers paint from a whole device pixel on.
  canvasPoint(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    return {x: clientX * this.ratio - Math.round(box.left * this.ratio),
      y: clientY * this.ratio - Math.round(box.top * this.ratio)};
  }

  // The picture's pixel under a point of the page, or null.
  pixelAt(clientX, clientY) {
    const at = this.canvasPoint(clientX, clientY);
    const {scale, x, y} = this.geometry();
    const px = Math.floor((at.x - x) / scale);
    const py = Math.floor((at.y - y) / scale);
    return px >= 0 && py >= 0 && px < this.size.width && py < this.size.height ? {x: px, y: py} : null;
  }

  // Zooms so that what lies at `at` (canvas pixels; the middle when not given) stays there.
  setZoom(zoom, at = {x: this.canvas.width / 2, y: this.canvas.height / 2}) {
    const before = this.geometry();
    const held = {x: (at.x - before.x) / before.scale, y: (at.y - before.y) / before.scale};
    this.zoom = zoom;
    const scale = this.scaleOf(zoom);
    this.center = {x: held.x + (this.canvas.width / 2 - at.x) / scale,
      y: held.y + (this.canvas.height / 2 - at.y) / scale};
    this.settle();
    this.frame.classList.toggle('can-pan', this.canPan());
    this.hear.zoomed(zoom);
    this.draw();
    this.tellPointed();
  }

  // One step in or out of what is shown, also from fitted.
  stepZoom(direction, at) {
    const scale = this.scaleOf(this.zoom);
    const steps = [kFit, ...kZooms].sort((a, b) => this.scaleOf(a) - this.scaleOf(b));
    const next = direction > 0 ? steps.find((step) => this.scaleOf(step) > scale * 1.01)
      : steps.reverse().find((step) => this.scaleOf(step) < scale * 0.99);
    if (next !== undefined) this.setZoom(next, at);
  }

  panBy(dx, dy) {
    const {scale} = this.geometry();
    this.center = {x: this.center.x - dx / scale, y: this.center.y - dy / scale};
    this.settle();
    this.draw();
    this.tellPointed();
  }

  // The centre as the frame's edges allow it: panning back must not first undo what went beyond them.
  settle() {
    const scale = this.scaleOf(this.zoom);
    const within = (center, extent, room) => {
      const half = Math.min(extent, room / scale) / 2;
      return Math.min(extent - half, Math.max(half, center));
    };
    this.center = {x: within(this.center.x, this.size.width, this.canvas.width),
      y: within(this.center.y, this.size.height, this.canvas.height)};
  }

  // The readout follows the pointer, and also the view when this moves below it.
  tellPointed() {
    this.hear.pointed(this.pointer && this.pixelAt(this.pointer.x, this.pointer.y));
  }

  source(canvas, scale) {
    const factor = Math.ceil(scale - 1e-6);
    if (scale <= 1 || Math.abs(scale - Math.round(scale)) < 1e-3) return canvas;
    if (canvas.width * canvas.height * factor ** 2 > kLargestEnlarged) return canvas;
    const known = this.enlarged.get(canvas);
    if (known?.factor === factor) return known.large;
    const large = enlarged(canvas, factor);
    this.enlarged.set(canvas, {factor, large});
    return large;
  }

  draw() {
    const {width, height} = this.canvas;
    if (width === 0 || height === 0) return;
    const context = this.canvas.getContext('2d');
    context.clearRect(0, 0, width, height);
    const {scale, x, y} = this.geometry();
    const split = Math.round(this.share * width);
    for (const [i, side] of this.sides.entries()) {
      if (!side) continue;
      const source = this.source(side, scale);
      context.save();
      context.beginPath();
      context.rect(i === 0 ? 0 : split, 0, i === 0 ? split : width - split, height);
      context.clip();
      context.imageSmoothingEnabled = scale < 1 || source !== side;
      context.imageSmoothingQuality = 'high';
      context.drawImage(source, x, y, this.size.width * scale, this.size.height * scale);
      context.restore();
    }
  }

  listen() {
    const {frame, divider} = this;
    let drag = null;
    const shareAt = (event) => {
      const box = frame.getBoundingClientRect();
      return (event.clientX - box.left - frame.clientLeft) / frame.clientWidth;
    };
    frame.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      const distance = Math.abs(shareAt(event) - this.share) * frame.clientWidth;
      drag = distance > kReach && this.canPan() ? {x: event.clientX, y: event.clientY} : 'divider';
      frame.setPointerCapture(event.pointerId);
      frame.classList.toggle('panning', drag !== 'divider');
      if (drag === 'divider') {
        if (distance > kReach) this.setShare(shareAt(event));
        divider.focus({preventScroll: true, focusVisible: false});
        event.preventDefault();
      }
    });
    frame.addEventListener('pointermove', (event) => {
      this.pointer = {x: event.clientX, y: event.clientY};
      if (drag === 'divider') {
        this.setShare(shareAt(event));
      } else if (drag) {
        this.panBy((event.clientX - drag.x) * this.ratio, (event.clientY - drag.y) * this.ratio);
        drag = {x: event.clientX, y: event.clientY};
      }
      this.tellPointed();
    });
    for (const end of ['pointerup', 'pointercancel']) {
      frame.addEventListener(end, () => {
        drag = null;
        frame.classList.remove('panning');
      });
    }
    frame.addEventListener('pointerleave', () => {
      this.pointer = null;
      this.tellPointed();
    });
    // The wheel alone scrolls the page, as everywhere; with Ctrl, or as a pinch, it zooms.
    frame.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      this.stepZoom(-Math.sign(event.deltaY), this.canvasPoint(event.clientX, event.clientY));
    }, {passive: false});
    divider.addEventListener('keydown', (event) => this.dividerKey(event));
    frame.addEventListener('keydown', (event) => this.frameKey(event));
  }

  dividerKey(event) {
    const step = event.shiftKey ? 0.1 : 0.01;
    const share = {ArrowLeft: this.share - step, ArrowDown: this.share - step, ArrowRight: this.share + step,
      ArrowUp: this.share + step, PageDown: this.share - 0.1, PageUp: this.share + 0.1, Home: 0, End: 1}[event.key];
    if (share === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.setShare(share);
  }

  frameKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = 40 * this.ratio;
    const move = {ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]}[event.key];
    if (move && this.canPan()) this.panBy(...move);
    else if (event.key === '+' || event.key === '=') this.stepZoom(1);
    else if (event.key === '-') this.stepZoom(-1);
    else if (event.key === '0') this.setZoom(kFit);
    else return;
    event.preventDefault();
  }
}
