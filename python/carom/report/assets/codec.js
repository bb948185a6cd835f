// Arrays as carom.report.codec packs them.
"use strict";
const carom = {};

carom.codec = (() => {
  const NOT_A_NUMBER = 0xffff;

  function bytesOf(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    return bytes;
  }

  async function inflated(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  // Planes of bytes back to numbers; the bytes of a number are little-endian, as typed arrays are
  // on every machine that browsers run on.
  function numbers(planes, Kind) {
    const size = Kind.BYTES_PER_ELEMENT;
    const count = planes.length / size;
    const bytes = new Uint8Array(planes.length);
    for (let plane = 0; plane < size; plane++) {
      const start = plane * count;
      for (let i = 0; i < count; i++) bytes[i * size + plane] = planes[start + i];
    }
    return new Kind(bytes.buffer);
  }

  const KINDS = { u4: Uint32Array, f4: Float32Array, f8: Float64Array, q2: Uint16Array };

  // A flat typed array, with its shape; of "q2" the codes, frame after frame.
  async function unpack(packed) {
    const array = numbers(await inflated(bytesOf(packed.data)), KINDS[packed.kind]);
    if (packed.kind === "q2") {
      const width = packed.shape[1] * packed.shape[2];
      for (let i = width; i < array.length; i++) array[i] += array[i - width];
    }
    return { ...packed, data: undefined, array };
  }

  // The values of one frame of a "q2" array, into a Float32Array or Float64Array.
  function frame(quantised, index, into) {
    const [, rows, components] = quantised.shape;
    const { low, step, array } = quantised;
    const start = index * rows * components;
    for (let i = 0; i < rows * components; i++) {
      const code = array[start + i];
      const k = i % components;
      into[i] = code === NOT_A_NUMBER ? NaN : low[k] + code * step[k];
    }
    return into;
  }

  return { bytesOf, unpack, frame };
})();
