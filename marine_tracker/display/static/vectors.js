// How far a target's vector reaches: true or relative, in the minutes that the viewer chose.

/**
 * The vector of a target, m; none where its motion, or own ship's, is not told.
 * @param {import('./settings.js').Settings} settings @param {Record<string, any>} own
 */
export function vectorOf(settings, own, vx, vy) {
  const seconds = 60 * settings.vectorMinutes;
  if (settings.vectors === 'relative') {
    const [wx, wy] = own.wx === null ? [own.vx, own.vy] : [own.wx, own.wy];
    return [(vx - wx) * seconds, (vy - wy) * seconds];
  }
  return own.stabilised === 'none' ? [0, 0] : [vx * seconds, vy * seconds];
}
