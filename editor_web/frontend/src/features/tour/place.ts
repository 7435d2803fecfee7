/** Where the card of the tour goes: beside what it is about, and not on what is needed for it. Pure. */

export interface Box {
  readonly left: number
  readonly top: number
  readonly width: number
  readonly height: number
}

export interface Corner {
  readonly left: number
  readonly top: number
}

type Size = Pick<Box, 'width' | 'height'>

const GAP = 14
const MARGIN = 10

/** The corner of a card: beside the target where there is room, else at an edge of the screen; `clear` stays free if it can. */
export function placeBeside(target: Box | undefined, card: Size, screen: Size, clear: readonly Box[] = []): Corner {
  const left = Math.max(MARGIN, screen.width - card.width - MARGIN)
  const top = Math.max(MARGIN, screen.height - card.height - MARGIN)
  const edges = [
    { left, top },
    { left: MARGIN, top },
    { left, top: MARGIN },
    { left: MARGIN, top: MARGIN },
  ]
  const places = target ? [...beside(target, card, { left, top }), ...edges] : edges
  const kept = places.filter((at) => isWithin(at, { left, top }) && !(target && overlaps(at, card, target)))
  return kept.find((at) => !clear.some((box) => overlaps(at, card, box))) ?? kept[0] ?? { left, top }
}

function beside(target: Box, card: Size, last: Corner): readonly Corner[] {
  const across = clamp(target.left + target.width / 2 - card.width / 2, last.left)
  const along = clamp(target.top + target.height / 2 - card.height / 2, last.top)
  return [
    { left: target.left + target.width + GAP, top: along },
    { left: target.left - GAP - card.width, top: along },
    { left: across, top: target.top + target.height + GAP },
    { left: across, top: target.top - GAP - card.height },
  ]
}

function isWithin(at: Corner, last: Corner): boolean {
  return at.left >= MARGIN && at.top >= MARGIN && at.left <= last.left && at.top <= last.top
}

function overlaps(at: Corner, card: Size, box: Box): boolean {
  const isApartAcross = at.left >= box.left + box.width || at.left + card.width <= box.left
  return !isApartAcross && at.top < box.top + box.height && at.top + card.height > box.top
}

function clamp(value: number, last: number): number {
  return Math.max(MARGIN, Math.min(value, last))
}
