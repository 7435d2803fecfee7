/** Following shows what is active, and moves the view no more than needed. */
import { expect, it } from 'vitest'
import { placeOf, viewThatShows } from './following'

const PANE = { width: 800, height: 400 }
const state = (x: number, y: number) => ({ x, y, width: 200, height: 80 })

it('stays where it is while all that is active is seen and can be read', () => {
  expect(viewThatShows([state(100, 100), state(400, 100)], { x: 0, y: 0, zoom: 1 }, PANE)).toBeUndefined()
})

it('pans without a change of zoom to what is out of sight', () => {
  const view = viewThatShows([state(2000, 900)], { x: 0, y: 0, zoom: 0.8 }, PANE)
  expect(view).toEqual({ x: 400 - 2100 * 0.8, y: 200 - 940 * 0.8, zoom: 0.8 })
})

it('zooms in where it is too small to be read, and out until concurrent states are seen together', () => {
  expect(viewThatShows([state(0, 0)], { x: 0, y: 0, zoom: 0.2 }, PANE)?.zoom).toBe(1)
  const apart = [state(0, 0), state(1800, 0)]
  const view = viewThatShows(apart, { x: 0, y: 0, zoom: 1 }, PANE) ?? { x: NaN, y: NaN, zoom: NaN }
  for (const { x, width } of apart) {
    expect(x * view.zoom + view.x).toBeGreaterThanOrEqual(0)
    expect((x + width) * view.zoom + view.x).toBeLessThanOrEqual(PANE.width)
  }
  expect(viewThatShows(apart, view, PANE)).toBeUndefined()
})

it('moves nothing where nothing is active', () => {
  expect(viewThatShows([], { x: 5, y: 5, zoom: 0.1 }, PANE)).toBeUndefined()
})

it('knows where a node inside of containers is', () => {
  const boxes = new Map([
    ['root/in', state(100, 50)],
    ['root/in/a', state(16, 40)],
  ])
  expect(placeOf('root/in/a', { boxes })).toEqual(state(116, 90))
  expect(placeOf('root/other', { boxes })).toBeUndefined()
})
