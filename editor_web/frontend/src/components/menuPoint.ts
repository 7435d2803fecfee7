/** Where the menu of an element opens: at the pointer, or in its middle where a key asked for it. */
import type { MouseEvent } from 'react'
import type { Point } from '../document/geometry'

export function pointOf({ clientX, clientY, currentTarget }: MouseEvent): Point {
  if (clientX !== 0 || clientY !== 0) return { x: clientX, y: clientY }
  const box = currentTarget.getBoundingClientRect()
  return { x: box.left + box.width / 2, y: box.top + box.height / 2 }
}
