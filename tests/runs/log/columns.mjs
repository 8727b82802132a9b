// The columns of a log's blocks, decoded by docs/log.md alone.
const buffer = new DataView(new ArrayBuffer(8));

export function real(bits) {
  buffer.setBigUint64(0, bits);
  return buffer.getFloat64(0);
}

export function single(bits) {
  buffer.setUint32(0, Number(bits));
  return buffer.getFloat32(0);
}

export function singleBits(x) {
  buffer.setFloat32(0, x);
  return BigInt(buffer.getUint32(0));
}

function realBits(x) {
  if (Number.isNaN(x)) return 0n;
  buffer.setFloat64(0, x);
  return buffer.getBigUint64(0);
}

export class ColumnDecoder {
  constructor(bits, columns, known, period) {
    this.bytes = bits / 8;
    this.mask = (1n << BigInt(bits)) - 1n;
    this.sign = 1n << BigInt(bits - 1);
    Object.assign(this, {columns, known, period});
    this.before = [];  // rows before the block, as integers in the order of their values
  }

  ordered(x) {
    return (x & this.sign) !== 0n ? ~x & this.mask : x | this.sign;
  }

  plain(x) {
    return (x & this.sign) !== 0n ? x ^ this.sign : ~x & this.mask;
  }

  // Rows of words; known: rows of the columns that are not coded.
  decode(bytes, rows, continues, known) {
    if (!continues) this.before = [];
    const seen = this.before.length;
    const table = [...this.before, ...Array.from({length: rows}, (_, k) => (known?.[k] ?? []).map((x) => this.ordered(x)))];
    const word = (c, k) => table[k + seen]?.[c] ?? 0n;
    const heads = [];
    let at = 0;
    for (let c = this.known; c < this.columns; ++c) {
      const head = {order: bytes[at] & 3, relation: bytes[at] >> 2, present: bytes[at + 1]};
      at += 2;
      if (head.relation !== 0) {
        head.other = bytes[at] | bytes[at + 1] << 8;
        at += 2;
      }
      heads.push(head);
    }
    for (let c = this.known; c < this.columns; ++c) {
      const head = heads[c - this.known];
      const left = Array(rows).fill(0n);
      for (let b = 0; b < this.bytes; ++b) {
        if ((head.present >> b & 1) === 0) continue;
        for (let k = 0; k < rows; ++k) left[k] |= BigInt(bytes[at++]) << BigInt(8 * b);
      }
      const d = (k) => word(c, k) - this.expected(head, c, k, word);
      for (let k = 0; k < rows; ++k) {
        const r = (left[k] & 1n) === 0n ? left[k] >> 1n : ~(left[k] >> 1n);
        const order = Math.min(head.order, k + seen);
        const q = [() => 0n, () => d(k - 1), () => 2n * d(k - 1) - d(k - 2),
                   () => 3n * (d(k - 1) - d(k - 2)) + d(k - 3)][order]();
        table[k + seen][c] = r + q + this.expected(head, c, k, word) & this.mask;
      }
    }
    if (at !== bytes.length) throw new Error(`${bytes.length - at} bytes too many in a block`);
    this.before = table.slice(-4);
    return table.slice(seen).map((row) => row.map((x) => this.plain(x)));
  }

  expected({relation, other}, c, k, word) {
    const number = (column, row) => real(this.plain(word(column, row)));
    switch (relation) {
      case 0: return 0n;
      case 1: return word(other, k);
      case 2: return word(other, k - 1);
      case 3: return ~word(other, k) & this.mask;
      case 7: {
        const [x, y, z] = [0, 1, 2].map((i) => number(other + i, k));
        const root = Math.sqrt(Math.max(0, 1 - x * x - y * y - z * z));
        const last = number(c, k - 1);
        const negative = last < 0 || Object.is(last, -0);
        return this.ordered(realBits(negative ? -root : root));
      }
      default: {
        const a = 0.25 * (relation - 2);
        const rate = (1 - a) * number(other, k - 1) + a * number(other, k);
        return this.ordered(realBits(number(c, k - 1) + this.period * rate));
      }
    }
  }
}
