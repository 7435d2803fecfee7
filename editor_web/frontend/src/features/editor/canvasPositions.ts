/** Where things are on the canvas at present, for actions that move them. */
import type { Arrangement } from '../../document/editing/arrange'

type Places = Omit<Arrangement, 'size'>

let places: Places = { boxes: new Map(), outer: new Set(), routes: new Map(), origins: new Map() }

/** Say what is drawn now. */
export function setCanvasPositions(arrangement: Places): void {
  places = arrangement
}

/** Boxes relative to their frames, and what to take off to get positions of the document. */
export function canvasBoxes(): Places {
  return places
}
