// Values as a person reads and types them.

/** How words can be shown. */
export const RADICES = ["decimal", "binary", "octal", "hex", "ascii"];

/** The two characters of a word, as the vendor shows them. */
function characters(word) {
  const one = (code) => (code >= 32 && code < 127 ? String.fromCharCode(code) : `\\${code.toString(16).toUpperCase().padStart(2, "0")}`);
  return one((word >> 8) & 0xff) + one(word & 0xff);
}

/** A value as text, for words in one of the radices. */
export function shown(value, radix = "decimal") {
  if (value === undefined) return "…";
  if (value === null) return "–";
  if (typeof value !== "number" || !Number.isInteger(value) || radix === "decimal") return String(value);
  const wide = value < -32768 || value > 32767;
  const unsigned = wide ? value >>> 0 : value & 0xffff;
  if (radix === "ascii") return wide ? characters(unsigned >>> 16) + characters(unsigned) : characters(unsigned);
  if (radix === "octal") return unsigned.toString(8).padStart(wide ? 11 : 6, "0");
  const bits = unsigned.toString(radix === "hex" ? 16 : 2);
  if (radix === "hex") return bits.toUpperCase().padStart(wide ? 8 : 4, "0") + "h";
  return bits.padStart(wide ? 32 : 16, "0").replace(/(.{4})(?=.)/g, "$1 ");
}

/**
 * What a person typed, as the server takes it: numbers as numbers, `1F0h` and `0x1F0` as hex, 16 or 32 binary digits or
 * groups of four as bits, other things as text.
 */
export function typed(text) {
  const plain = text.trim();
  if (/^[0-9a-f]+h$/i.test(plain)) return "0x" + plain.slice(0, -1);
  if (/^([01]{4}( [01]{4})+|[01]{16}|[01]{32})$/.test(plain)) {
    // As hex, because digits of bits say nothing of a sign.
    return "0x" + Number.parseInt(plain.replaceAll(" ", ""), 2).toString(16);
  }
  if (plain !== "" && !/^0x/i.test(plain) && Number.isFinite(Number(plain))) return Number(plain);
  return text;
}
