// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Reads what a page holds; asset_tools/view/src/page_content.h has the layout.

const unpackBase64 = (text) => {
  const raw = atob(text.trim());
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
};

const inflated = async (bytes) => {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
};

/** A document with the bytes that it names. */
export class Content {
  constructor(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    this.document = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    this.buffer = buffer;
    this.start = Math.ceil((4 + length) / 4) * 4;
  }

  static async fromPage() {
    const element = document.getElementById('content');
    const text = element.textContent;
    element.remove(); // megabytes of text that nobody needs any longer
    return new Content(await inflated(unpackBase64(text)));
  }

  static async fromBytes(bytes) {
    return new Content(await inflated(bytes));
  }

  bytes({ at, bytes }) {
    return new Uint8Array(this.buffer, this.start + at, bytes);
  }

  floats(at, count) {
    return new Float32Array(this.buffer, this.start + at, count);
  }

  /** The mesh at this place of the list: positions [m], three a vertex, and indices, three a triangle. */
  mesh(place) {
    const { at, vertices, triangles, wide, least, step, uv } = this.document.meshes[place];
    const steps = new Uint16Array(this.buffer, this.start + at, vertices * 3);
    const positions = new Float32Array(vertices * 3);
    for (let i = 0; i < positions.length; ++i) positions[i] = least[i % 3] + steps[i] * step[i % 3];
    const Indices = wide ? Uint32Array : Uint16Array;
    const behind = this.start + at + Math.ceil((vertices * 6) / 4) * 4;
    const indices = new Indices(this.buffer, behind, triangles * 3);
    return { positions, indices, uv: uv === undefined ? null : this.floats(uv, triangles * 6) };
  }
}
