// Forces in words, by the scale [N] that they are read on: below 0.1 N in mN.
const unitOf = (scale) => (scale < 0.1 ? { name: 'mN', each: 1e3 } : { name: 'N', each: 1 });

export const forceUnit = (scale) => unitOf(scale).name;

// A mark of the scale: exact, without its unit.
export function forceMark(newtons, scale) {
  return String(+(unitOf(scale).each * newtons).toPrecision(3));
}

// To a thousandth of the scale's decade, so that digits do not come and go.
export function forceReading(newtons, scale) {
  const { name, each } = unitOf(scale), digits = Math.max(2 - Math.floor(Math.log10(each * scale)), 0);
  return `${(each * newtons).toFixed(digits)} ${name}`;
}
