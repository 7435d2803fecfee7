import { expect, test } from 'vitest'
import { placeBeside, type Box } from './place'

const SCREEN = { width: 1280, height: 800 }
const CARD = { width: 320, height: 200 }

function overlaps(target: Box, at: { left: number; top: number }): boolean {
  const isApart =
    at.left >= target.left + target.width ||
    at.left + CARD.width <= target.left ||
    at.top >= target.top + target.height ||
    at.top + CARD.height <= target.top
  return !isApart
}

test('the card stands beside what it is about, wholly on the screen', () => {
  for (let left = 0; left < 1240; left += 62)
    for (let top = 0; top < 770; top += 55) {
      const target = { left, top, width: 40, height: 30 }
      const at = placeBeside(target, CARD, SCREEN)
      expect(overlaps(target, at)).toBe(false)
      expect(at.left).toBeGreaterThanOrEqual(0)
      expect(at.top).toBeGreaterThanOrEqual(0)
      expect(at.left + CARD.width).toBeLessThanOrEqual(SCREEN.width)
      expect(at.top + CARD.height).toBeLessThanOrEqual(SCREEN.height)
    }
})

test('without room beside it goes to an edge, and without a target to the last corner', () => {
  expect(placeBeside(undefined, CARD, SCREEN)).toEqual({ left: 950, top: 590 })
  expect(placeBeside({ left: 0, top: 0, width: 1280, height: 800 }, CARD, SCREEN)).toEqual({ left: 950, top: 590 })
  const phone = { width: 390, height: 844 }
  expect(placeBeside({ left: 0, top: 500, width: 390, height: 300 }, { width: 370, height: 220 }, phone).top).toBe(266)
})

test('what is to be kept clear stays so while there is another place', () => {
  const library = { left: 10, top: 400, width: 200, height: 28 }
  const canvas = { left: 230, top: 130, width: 700, height: 640 }
  const at = placeBeside(library, CARD, SCREEN, [canvas])
  expect(overlaps(canvas, at) || overlaps(library, at)).toBe(false)
  expect(placeBeside(library, CARD, SCREEN).left).toBe(224)
})
