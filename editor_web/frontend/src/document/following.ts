/** What part of a drawing is seen while it is followed: moved no more than needed. Pure. */
import type { Box, Point, Size } from './geometry'
import type { Layout } from './layout'
import { pathsTo } from './path'

export interface View extends Point {
  readonly zoom: number
}

/** The least zoom at which the state of a node can be read. */
const READABLE = 0.62
/** From what is followed to the border of the pane. */
const MARGIN = 28

/** Where a node is in the whole drawing. */
export function placeOf(path: string, { boxes }: Pick<Layout, 'boxes'>): Box | undefined {
  const own = boxes.get(path)
  const around = pathsTo(path)
    .slice(0, -1)
    .map((each) => boxes.get(each))
  const along = (side: 'x' | 'y') => around.reduce((sum, each) => sum + (each?.[side] ?? 0), 0)
  return own && { ...own, x: own.x + along('x'), y: own.y + along('y') }
}

/** The view in which all of these are seen and can be read; undefined where they are already. */
export function viewThatShows(places: readonly Box[], view: View, pane: Size): View | undefined {
  if (places.length === 0) return undefined
  const left = Math.min(...places.map(({ x }) => x))
  const top = Math.min(...places.map(({ y }) => y))
  const width = Math.max(...places.map((place) => place.x + place.width)) - left
  const height = Math.max(...places.map((place) => place.y + place.height)) - top
  const fit = Math.min((pane.width - 2 * MARGIN) / width, (pane.height - 2 * MARGIN) / height)
  const readable = Math.min(READABLE, fit)
  const [x, y] = [left * view.zoom + view.x, top * view.zoom + view.y]
  const isSeen = x >= 0 && y >= 0 && x + width * view.zoom <= pane.width && y + height * view.zoom <= pane.height
  if (isSeen && view.zoom >= readable) return undefined
  const zoom = view.zoom >= readable && view.zoom <= fit ? view.zoom : Math.min(1, fit)
  return { x: pane.width / 2 - (left + width / 2) * zoom, y: pane.height / 2 - (top + height / 2) * zoom, zoom }
}
