/** The log of a run: its lines, what is found in it, and the causes of failures. */
import { screen, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, show, snapshot } from '../../../testing/page'
import type { LogLine } from '../../api/types'
import { EventLog } from './EventLog'

const CAUSES = [
  {
    message: 'no contact on either pad',
    where: 'left/gripper/gripper_grasp',
    kind: 'GraspFailed',
    compared: [],
    skill: 'left gripper: grasp',
  },
  { message: 'the part has slipped', where: '', kind: 'PartLost', compared: [], skill: '' },
  { message: 'root/grasp failed', where: 'root/grasp', kind: 'StateError', compared: [], skill: '' },
]

function line(seq: number, told: Partial<LogLine> = {}): LogLine {
  return { seq, time_s: seq / 10, kind: 'node_entered', level: 'info', path: 'root/grasp', text: `line ${seq}`, causes: [], ...told }
}

const LINES = [
  line(1, { kind: 'run_started', path: '', text: 'run started: shift' }),
  line(2, { level: 'debug', text: 'ticked' }),
  line(3, { level: 'warning', text: 'slow' }),
  line(4, { level: 'error', text: 'it has failed', causes: CAUSES }),
]

function log() {
  return within(screen.getByRole('log', { name: 'Events' }))
}

it('shows what happened with its time and place, and what comes later', () => {
  const socket = live({ log: LINES })
  show(<EventLog />)
  expect(screen.getByRole('log')).toHaveTextContent('0.100inforunrun started: shift')
  expect(log().queryByText('ticked')).toBeNull()
  socket.tell(snapshot({ log: [...LINES, line(5, { text: 'run ended' })] }))
  expect(log().getByText('run ended')).toBeVisible()
})

it.each([
  ['All', ['run started: shift', 'ticked', 'slow', 'it has failed']],
  ['Warnings', ['slow', 'it has failed']],
  ['Errors', ['it has failed']],
])('shows at %s what is at least so bad', async (level, texts) => {
  live({ log: LINES })
  const user = show(<EventLog />)
  await user.click(screen.getByLabelText(level))
  for (const { text } of LINES) expect(log().queryByText(text) !== null).toBe(texts.includes(text))
})

it('finds lines by their words, and says when none matches', async () => {
  live({ log: LINES })
  const user = show(<EventLog />)
  await user.type(screen.getByLabelText('Find in the log'), 'slow')
  expect(log().getByText('slow')).toBeVisible()
  expect(log().queryByText('run started: shift')).toBeNull()
  await user.type(screen.getByLabelText('Find in the log'), 'er')
  expect(log().getByText('No line matches')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Clear' }))
  expect(log().getByText('run started: shift')).toBeVisible()
})

it('unfolds the causes of a failure, from what was measured on', async () => {
  live({ log: LINES })
  const user = show(<EventLog />)
  const fold = log().getByRole('button', { name: /^3 causes: it has failed/ })
  expect(fold).toHaveAttribute('aria-expanded', 'false')
  await user.click(fold)
  const causes = within(log().getByRole('list')).getAllByRole('listitem')
  expect(causes.map((each) => each.firstChild?.textContent)).toEqual([
    'left gripper: grasp: no contact on either pad',
    'the part has slipped',
    'root/grasp failed',
  ])
  expect(causes[0]).toHaveTextContent('GraspFailed · left')
  await user.click(fold)
  expect(log().queryByRole('list')).toBeNull()
})

it('counts what is only in the journal', () => {
  live({ log: [line(31), line(32)] })
  show(<EventLog />)
  expect(log().getByText('30 earlier lines are in the journal')).toBeVisible()
})

it('says what to do while nothing has happened', () => {
  live()
  show(<EventLog />)
  expect(log().getByText('Nothing has happened yet')).toBeVisible()
})
