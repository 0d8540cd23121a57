// Arrays of the page, as tools/view/packed.cpp packs them.

function decoded(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// The bytes of array `number`; its text is dropped from the page.
export async function unpackedBytes(number) {
  const element = document.getElementById(`array-${number}`);
  const bytes = decoded(element.textContent);
  element.remove();
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function greysOf(number) {
  const greys = await unpackedBytes(number);
  for (let i = 1; i < greys.length; ++i) greys[i] += greys[i - 1];
  return greys;
}

async function wordsOf(number) {
  const bytes = await unpackedBytes(number);
  const count = bytes.length / 4;
  const words = new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    words[i] = bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
  }
  return words;
}

export async function floatsOf(number) {
  return new Float32Array((await wordsOf(number)).buffer);
}

export async function indicesOf(number) {
  const words = await wordsOf(number);
  let last = 0;
  for (let i = 0; i < words.length; ++i) {
    last = (last + ((words[i] >>> 1) ^ -(words[i] & 1))) >>> 0;
    words[i] = last;
  }
  return words;
}
