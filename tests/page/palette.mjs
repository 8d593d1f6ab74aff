// Differences of colours as people with and without colour blindness see them.

// Machado, Oliveira, Fernandes (2009), severity 1, for linear RGB.
export const visions = {
  usual: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  protanopia: [
    0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998,
  ],
  deuteranopia: [
    0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881,
  ],
  tritanopia: [
    1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039,
  ],
};

// Linear sRGB to CIE XYZ, relative to white D65.
const toXyz = [
  0.433953, 0.376219, 0.189828, 0.212671, 0.71516, 0.072169, 0.017758, 0.109477, 0.872766,
];
const times = (m, v) => [0, 3, 6].map((k) => m[k] * v[0] + m[k + 1] * v[1] + m[k + 2] * v[2]);

/** Linear components of an [r, g, b] of 0 to 255. */
const linear = (rgb) =>
  rgb.map((v) => (v <= 10.3 ? v / 3294.6 : ((v / 255 + 0.055) / 1.055) ** 2.4));

function lab(rgb, vision) {
  const seen = times(visions[vision], linear(rgb)).map((v) => Math.min(Math.max(v, 0), 1));
  const [x, y, z] = times(toXyz, seen).map((v) =>
    v > 0.008856 ? Math.cbrt(v) : 7.787 * v + 16 / 116,
  );
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

const degrees = 180 / Math.PI;
const angle = (b, a) => (Math.atan2(b, a) * degrees + 360) % 360;

/** Difference of two colours by CIEDE2000; about 2 is just noticeable side by side. */
export function difference(one, other, vision = "usual") {
  const [[l1, a1, b1], [l2, a2, b2]] = [lab(one, vision), lab(other, vision)];
  const mean = ((Math.hypot(a1, b1) + Math.hypot(a2, b2)) / 2) ** 7;
  const g = 1.5 - 0.5 * Math.sqrt(mean / (mean + 25 ** 7));
  const [c1, c2] = [Math.hypot(g * a1, b1), Math.hypot(g * a2, b2)];
  const [h1, h2] = [angle(b1, g * a1), angle(b2, g * a2)];
  const turn = ((h2 - h1 + 540) % 360) - 180;
  const [l, c, h] = [(l1 + l2) / 2, (c1 + c2) / 2, h1 + turn / 2];
  const cos = (k, shift) => Math.cos((k * h + shift) / degrees);
  const t = 1 - 0.17 * cos(1, -30) + 0.24 * cos(2, 0) + 0.32 * cos(3, 6) - 0.2 * cos(4, -63);
  const dl = (l2 - l1) / (1 + (0.015 * (l - 50) ** 2) / Math.sqrt(20 + (l - 50) ** 2));
  const dc = (c2 - c1) / (1 + 0.045 * c);
  const dh = (2 * Math.sqrt(c1 * c2) * Math.sin(turn / 2 / degrees)) / (1 + 0.015 * c * t);
  const around = (((h + 360) % 360) - 275) / 25;
  const rotation =
    -2 *
    Math.sqrt(c ** 7 / (c ** 7 + 25 ** 7)) *
    Math.sin((60 * Math.exp(-(around ** 2))) / degrees);
  return Math.sqrt(dl ** 2 + dc ** 2 + dh ** 2 + rotation * dc * dh);
}

/** The least difference of two colours over all visions. */
export const leastDifference = (one, other) =>
  Math.min(...Object.keys(visions).map((vision) => difference(one, other, vision)));

/** Contrast of two colours as WCAG defines it. */
export function contrast(one, other) {
  const light = [one, other].map((rgb) => times(toXyz, linear(rgb))[1] + 0.05);
  return Math.max(...light) / Math.min(...light);
}
