/** Poses in words. */
import { degrees, rollPitchYaw } from '../../document/teaching'

/** A pose in millimetres and degrees. */
export function poseWords(pose: readonly number[]): string {
  const place = pose.slice(0, 3).map((value) => digits(value * 1000))
  const turn = rollPitchYaw(pose.slice(3)).map((value) => `${digits(degrees(value))}°`)
  return `${place.join('  ')} mm   ${turn.join('  ')}`
}

/** Without the minus of what is rounded to zero. */
function digits(value: number): string {
  return value.toFixed(1).replace(/^-(0\.0)$/, '$1')
}
