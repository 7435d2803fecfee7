/** The commands that put nodes elsewhere on the canvas. */
import { nudge } from './actions'
import type { Action } from './command'
import { align, layOutAnew, layOutSelected } from './placing'

const STEP = 20

function aligning(to: Parameters<typeof align>[0]): Action {
  return { needs: 'nodes', run: () => void align(to) }
}

function moving(x: number, y: number): Action {
  return { needs: 'node', run: () => void nudge(x, y) }
}

export const ARRANGING = {
  layout: { run: () => void layOutAnew() },
  'layout-selected': { needs: 'nodes', run: () => void layOutSelected() },
  'align-left': aligning('left'),
  'align-right': aligning('right'),
  'align-bottom': aligning('bottom'),
  'align-top': aligning('top'),
  'align-row': aligning('row'),
  'align-column': aligning('column'),
  'distribute-across': aligning('across'),
  'distribute-down': aligning('down'),
  left: moving(-STEP, 0),
  right: moving(STEP, 0),
  up: moving(0, -STEP),
  down: moving(0, STEP),
} satisfies Record<string, Action>
