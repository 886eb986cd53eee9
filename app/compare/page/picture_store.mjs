// The embedded pictures, decoded when they are looked at: there may be many, and large ones.

const kKept = 8;  // decoded pictures: the four on view and as many that one may go back to

function bytesOf(dataUri) {
  const text = atob(dataUri.slice(dataUri.indexOf(',') + 1));
  return Uint8Array.from(text, (character) => character.charCodeAt(0));
}

async function decode(dataUri) {
  // Without conversion of colours: error pictures hold levels, not colours.
  const bitmap = await createImageBitmap(new Blob([bytesOf(dataUri)], {type: 'image/png'}),
    {colorSpaceConversion: 'none', premultiplyAlpha: 'none'});
  const canvas = document.createElement('canvas');
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return {canvas, width: canvas.width, height: canvas.height,
    pixels: context.getImageData(0, 0, canvas.width, canvas.height).data};
}

export class PictureStore {
  constructor(pictures) {
    this.pictures = pictures;
    this.decoded = new Map();  // oldest use first
  }

  has(key) {
    return typeof key === 'string' && key in this.pictures;
  }

  // A promise of {canvas, width, height, pixels}, or of null for a picture that is not there.
  get(key) {
    if (!this.has(key)) return Promise.resolve(null);
    const picture = this.decoded.get(key) ?? decode(this.pictures[key]);
    this.decoded.delete(key);
    this.decoded.set(key, picture);
    if (this.decoded.size > kKept) this.decoded.delete(this.decoded.keys().next().value);
    return picture;
  }
}
