/** The commands that put nodes elsewhere on the canvas. */
import { nudge } from './actions'
import type { Command } from './command'
import { align, layOutAnew } from './placing'

const STEP = 20

export const ARRANGING: readonly Command[] = [
  { id: 'layout', part: 'Arrange', words: 'Auto-layout', chords: [{ key: 'l' }], run: () => void layOutAnew() },
  { id: 'align-left', part: 'Arrange', words: 'Align left', chords: [], needs: 'nodes', run: () => void align('left') },
  { id: 'align-right', part: 'Arrange', words: 'Align right', chords: [], needs: 'nodes', run: () => void align('right') },
  { id: 'align-bottom', part: 'Arrange', words: 'Align bottom', chords: [], needs: 'nodes', run: () => void align('bottom') },
  { id: 'align-top', part: 'Arrange', words: 'Align top', chords: [], needs: 'nodes', run: () => void align('top') },
  { id: 'align-row', part: 'Arrange', words: 'Put in a row', chords: [], needs: 'nodes', run: () => void align('row') },
  {
    id: 'align-column',
    part: 'Arrange',
    words: 'Put in a column',
    chords: [],
    needs: 'nodes',
    run: () => void align('column'),
  },
  {
    id: 'distribute-across',
    part: 'Arrange',
    words: 'Distribute horizontally',
    chords: [],
    needs: 'nodes',
    run: () => void align('across'),
  },
  {
    id: 'distribute-down',
    part: 'Arrange',
    words: 'Distribute vertically',
    chords: [],
    needs: 'nodes',
    run: () => void align('down'),
  },
  {
    id: 'left',
    part: 'Arrange',
    words: 'Move left, or before its sibling',
    chords: [{ key: 'ArrowLeft', alt: true }],
    needs: 'node',
    run: () => void nudge(-STEP, 0),
  },
  {
    id: 'right',
    part: 'Arrange',
    words: 'Move right, or behind its sibling',
    chords: [{ key: 'ArrowRight', alt: true }],
    needs: 'node',
    run: () => void nudge(STEP, 0),
  },
  {
    id: 'up',
    part: 'Arrange',
    words: 'Move up',
    chords: [{ key: 'ArrowUp', alt: true }],
    needs: 'node',
    run: () => void nudge(0, -STEP),
  },
  {
    id: 'down',
    part: 'Arrange',
    words: 'Move down',
    chords: [{ key: 'ArrowDown', alt: true }],
    needs: 'node',
    run: () => void nudge(0, STEP),
  },
]
