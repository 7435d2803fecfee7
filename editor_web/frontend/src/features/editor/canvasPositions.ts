/** Where things are on the canvas at present, for actions that move them. */
import { pageStore } from '../../api/pageStore'
import type { Arrangement } from '../../document/editing/arrange'

type Places = Omit<Arrangement, 'size'>

const NOTHING: Places = { boxes: new Map(), outer: new Set(), routes: new Map(), origins: new Map() }
/** For what is drawn at places that it gives. */
export const useCanvasPlaces = pageStore(() => NOTHING)

/** Say what is drawn now. */
export function setCanvasPositions(arrangement: Places): void {
  useCanvasPlaces.setState(arrangement, true)
}

/** Boxes relative to their frames, and what to take off to get positions of the document. */
export function canvasBoxes(): Places {
  return useCanvasPlaces.getState()
}
