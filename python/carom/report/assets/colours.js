// From values to colours: the maps, and the range of a field.
carom.colours = (() => {
  function textures(maps) {
    const made = {};
    for (const [name, base64] of Object.entries(maps)) {
      const bytes = carom.codec.bytesOf(base64);
      const texture = new THREE.DataTexture(bytes, 256, 1, THREE.RGBAFormat);
      texture.colorSpace = THREE.SRGBColorSpace;
      texture.minFilter = texture.magFilter = THREE.LinearFilter;
      texture.needsUpdate = true;
      made[name] = { texture, bytes };
    }
    return made;
  }

  // Smallest and largest value; where there is none the first is above the second.
  function extremes(values) {
    let low = Infinity;
    let high = -Infinity;
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return { low, high };
  }

  // The values of the first and the last colour; those with a sign keep zero in the middle.
  function range(values, isSigned) {
    let { low, high } = extremes(values);
    if (low > high) return { low: 0, high: 1 };
    if (isSigned) {
      high = Math.max(Math.abs(low), Math.abs(high));
      low = -high;
    } else if (low >= 0 && low < 0.5 * high) low = 0;
    return high > low ? { low, high } : { low, high: low + (Math.abs(low) || 1) * 1e-6 };
  }

  // Where in a map of 256 colours a value is, such that the ends are the first and last colour.
  function place(value, { low, high }) {
    const share = (value - low) / (high - low);
    return (0.5 + 255 * Math.min(1, Math.max(0, Number.isNaN(share) ? 0 : share))) / 256;
  }
  return { textures, extremes, range, place };
})();
