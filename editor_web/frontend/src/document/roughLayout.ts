/** How large the layout engine would about make a graph, in no time: to choose what is then laid out by it. Pure. */
import type { ElkShape, LayoutCall } from './layout'

const ALONG = 56
const ACROSS = 26

/** Nodes one after the other, in rows where the engine would wrap them. */
export const layOutRoughly: LayoutCall = (graph) => {
  const isDown = graph.layoutOptions?.['elk.direction'] === 'DOWN'
  const children = (graph.children ?? []).map((child) => turned(child, isDown))
  const room = children.reduce((sum, { width = 0, height = 0 }) => sum + (width + ALONG) * (height + ACROSS), 0)
  const ratio = graph.layoutOptions?.['elk.aspectRatio']
  const limit = ratio === undefined ? Infinity : Math.sqrt(room * Number(ratio))
  let [x, y, row, widest] = [0, 0, 0, 0]
  const placed = children.map((child) => {
    const { width = 0, height = 0 } = child
    if (x > 0 && x + width > limit) [x, y, row] = [0, y + row + ACROSS, 0]
    const at = { ...child, x, y }
    x += width + ALONG
    row = Math.max(row, height)
    widest = Math.max(widest, x - ALONG)
    return turned(at, isDown)
  })
  return Promise.resolve({
    ...graph,
    children: placed,
    edges: [],
    ...turned({ id: '', width: widest, height: y + row }, isDown),
    id: graph.id,
  })
}

function turned(shape: ElkShape, isDown: boolean): ElkShape {
  const { x, y, width, height } = shape
  return isDown ? { ...shape, ...given({ x: y, y: x, width: height, height: width }) } : shape
}

function given(box: Readonly<Record<string, number | undefined>>): Partial<ElkShape> {
  return Object.fromEntries(Object.entries(box).filter(([, value]) => value !== undefined))
}
