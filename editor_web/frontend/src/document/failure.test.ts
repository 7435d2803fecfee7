/** A failure in words. */
import { describe, expect, it } from 'vitest'
import type { MeasuredValue, RunComparison, RunFailure, RunView } from '../api/types'
import { differenceLines, expectedWords, measuredWords, missWords, placesOf, reportOf } from './failure'

const OPENING: MeasuredValue = { quantity: 'opening', measured: 1.2, unit: 'mm', least: 20, most: 40 }
const RUN: RunView = {
  id: 'r2',
  behavior: 'behaviors/pick.yaml',
  status: 'finished',
  outcome: 'missed',
  success: false,
  cause: '',
  started_at_s: 0,
  duration_s: 3,
  waits: '',
  ticking: false,
}
const FAILURE: RunFailure = {
  seq: 9,
  entered_seq: 7,
  time_s: 1.5,
  path: 'root/grasp',
  text: 'the fingers ended 1.2 mm apart',
  hint: 'look at the part',
  links: [
    {
      message: 'the fingers of the left one ended beside hca_north',
      where: 'right/gripper/grasp',
      kind: 'GraspFailed',
      skill: 'right gripper: grasp',
      compared: [OPENING],
    },
  ],
  steps: [],
  around: [{ seq: 8, time_s: 1.4, kind: 'goal', level: 'info', path: 'root/grasp', text: 'right/gripper/grasp sent', causes: [] }],
}
const PAST = { ...RUN, document: 'd', events: 9 }
const COMPARISON: RunComparison = {
  left: { ...PAST, id: 'r1', outcome: 'good', success: true },
  right: PAST,
  divergence: { kind: 'outcome', path: 'root/grasp', index: 2, left_s: 1, right_s: 1.5, text: 'root/grasp ended with missed, held before' },
  visits: [],
  left_out: 0,
  data: [],
  data_left_out: 0,
  icons: {},
  nodes: [node('root', 2, 3), node('root/look', 1, 1.05), node('root/grasp', 0.5, 1.5), node('root/new', 0, 1, 0)],
  settings: [
    { at: 'parameters.width_m', left: '0.02', right: '0.03' },
    { at: 'inputs.tray', left: null, right: '"a"' },
  ],
  documents: [{ name: 'behaviors/pick.yaml', lines: [] }],
}

function node(path: string, left: number, right: number, visits = 1) {
  return { path, visits_left: visits, visits_right: 1, duration_left_s: left, duration_right_s: right }
}

describe('what was measured', () => {
  it.each([
    [OPENING, '1.2 mm', '20 to 40 mm', '18.8 mm too small'],
    [{ ...OPENING, least: null, measured: 41 }, '41 mm', 'at most 40 mm', '1 mm too large'],
    [{ ...OPENING, most: null, measured: 30 }, '30 mm', 'at least 20 mm', ''],
  ])('%j: %s, %s, %s', (value, measured, expected, miss) => {
    expect([measuredWords(value), expectedWords(value), missWords(value)]).toEqual([measured, expected, miss])
  })
})

it('names what differs from the last good run, and no container beside what is inside it', () => {
  expect(differenceLines(COMPARISON)).toEqual([
    'parameters.width_m: 0.02 before, 0.03 now',
    'inputs.tray: not set before, "a" now',
    'behaviors/pick.yaml has changed',
    'root/grasp: 0.50 s before, 1.50 s now',
  ])
})

it('finds what a failure names in the cell, an arm by its address only', () => {
  const places = placesOf(FAILURE, ['left', 'right'])
  expect(places).toContain('hca_north')
  expect(places.at(-1)).toBe('right')
  expect(places).not.toContain('left')
})

it('writes a report with everything that a colleague needs', () => {
  expect(reportOf(RUN, FAILURE, COMPARISON, 'http://h/runs/r2').split('\n').slice(2)).toEqual([
    'State: Failed: missed',
    'Where: root/grasp at 1.50 s',
    'What failed: the fingers ended 1.2 mm apart',
    'What to do: look at the part',
    'Page: http://h/runs/r2',
    '',
    'Why, innermost cause first:',
    '- right gripper: grasp: the fingers of the left one ended beside hca_north (GraspFailed, right/gripper/grasp)',
    '  opening: measured 1.2 mm, expected 20 to 40 mm',
    '',
    'What happened there:',
    '- 1.40 s right/gripper/grasp sent',
    '',
    'Against the last good run r1:',
    '- root/grasp ended with missed, held before',
    '- parameters.width_m: 0.02 before, 0.03 now',
    '- inputs.tray: not set before, "a" now',
    '- behaviors/pick.yaml has changed',
    '- root/grasp: 0.50 s before, 1.50 s now',
  ])
})
