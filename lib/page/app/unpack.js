// Arrays of whole numbers as PackedArrays (lib/page/packed_arrays.h) writes
// them, and the surfaces made of them.

/** The bytes of a base64 text that was deflated (RFC 1950). */
export async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(
      new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** An array: planes of bytes, low ones first, of zigzag differences from the
    value `lag` before. */
export function unpack(bytes, {offset, count, planes, lag}) {
  const values = new Int32Array(count);
  for (let p = 0; p < planes; ++p) {
    for (let i = 0; i < count; ++i) {
      values[i] |= bytes[offset + p * count + i] << (8 * p);
    }
  }
  for (let i = 0; i < count; ++i) {
    const value = (values[i] >>> 1) ^ -(values[i] & 1);
    values[i] = value + (i >= lag ? values[i - lag] : 0);
  }
  return values;
}

/** Whole numbers in units, as floats. */
function scaled(values, unit) {
  return Float32Array.from(values, value => value * unit);
}

/** A surface of a scene with its arrays in place of their headers. */
export function unpackSurface(bytes, header) {
  const arrays = {};
  for (const [name, where] of Object.entries(header.arrays)) {
    arrays[name] = unpack(bytes, where);
  }
  return {
    ...header, ...arrays,
    vertices: scaled(arrays.vertices, header.unit),
    positions: scaled(arrays.positions, header.unit),
  };
}
