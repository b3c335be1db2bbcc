// Values as a person reads and types them.

/** A value as text. `radix`: `decimal`, `binary` or `hex`, for words. */
export function shown(value, radix = "decimal") {
  if (value === undefined) return "…";
  if (value === null) return "–";
  if (typeof value !== "number" || !Number.isInteger(value) || radix === "decimal") return String(value);
  const wide = value < -32768 || value > 32767;
  const bits = (wide ? value >>> 0 : value & 0xffff).toString(radix === "hex" ? 16 : 2);
  if (radix === "hex") return bits.toUpperCase().padStart(wide ? 8 : 4, "0") + "h";
  return bits.padStart(wide ? 32 : 16, "0").replace(/(.{4})(?=.)/g, "$1 ");
}

/** What a person typed, as the server takes it: numbers as numbers, `1F0h` and `0x1F0` as hex, other things as text. */
export function typed(text) {
  const plain = text.trim();
  if (/^[0-9a-f]+h$/i.test(plain)) return "0x" + plain.slice(0, -1);
  if (/^[01 ]{9,}$/.test(plain)) {
    const word = Number.parseInt(plain.replaceAll(" ", ""), 2);
    return word > 32767 && word < 65536 ? word - 65536 : word;
  }
  if (plain !== "" && !/^0x/i.test(plain) && Number.isFinite(Number(plain))) return Number(plain);
  return text;
}
