/** Two runs compared: visits side by side, the first divergence, and what differs of one visit. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { server, show } from '../../testing/page'
import { Refusal } from '../../testing/server'
import type { AlignedVisit, PastRun, RunComparison, Visit } from '../api/types'
import { ComparePage } from './ComparePage'
import { goTo, LAST_GOOD, useRoute } from './route'

const opened = vi.fn()

function run(id: string, told: Partial<PastRun> = {}): PastRun {
  return {
    id,
    behavior: 'pick',
    document: 'd',
    status: 'finished',
    outcome: 'good',
    success: true,
    cause: '',
    started_at_s: 1000,
    duration_s: 4,
    waits: '',
    ticking: false,
    events: 9,
    ...told,
  }
}

function visit(told: Partial<Visit>): Visit {
  return { path: '', start_s: 0, end_s: 1, status: 'done', outcome: 'done', visit: 1, seq: 2, end_seq: 5, count: 1, cause: '', ...told }
}

function pair(path: string, left: Partial<Visit> | null, right: Partial<Visit> | null): AlignedVisit {
  return { path, left: left && visit({ path, ...left }), right: right && visit({ path, ...right }) }
}

const FOUND: RunComparison = {
  left: run('r1'),
  right: run('r2', { success: false, outcome: 'bad', cause: 'no contact' }),
  divergence: {
    kind: 'outcome',
    path: 'root/grasp',
    index: 2,
    left_s: 3,
    right_s: 3.5,
    text: 'root/grasp ended with done in the left run, and ended with failed in the right run',
  },
  visits: [
    pair('root', { end_s: 4 }, { end_s: 5, status: 'failed', outcome: 'bad' }),
    pair('root/move', {}, { end_s: 1.5 }),
    pair('root/grasp', { start_s: 1, end_s: 3 }, { start_s: 1.5, end_s: 3.5, status: 'failed', outcome: 'failed', cause: 'no contact' }),
    pair('root/lift', {}, null),
  ],
  left_out: 0,
  nodes: [
    { path: 'root/move', visits_left: 1, visits_right: 1, duration_left_s: 1, duration_right_s: 1.5 },
    { path: 'root/lift', visits_left: 1, visits_right: 0, duration_left_s: 1, duration_right_s: 0 },
  ],
  settings: [{ at: 'parameters.speed', left: '0.5', right: '0.7' }],
  documents: [{ name: 'pick.yaml', lines: ['-speed: 0.5', '+speed: 0.7'] }],
  data: [{ index: 2, path: 'root/grasp', kind: 'wrote', at: 'force_n', left: '12.5', right: null }],
  data_left_out: 0,
  icons: { root: 'sitemap', 'root/grasp': 'gripper' },
}

function Page() {
  const route = useRoute()
  return route.page === 'compare' ? <ComparePage left={route.left} right={route.right} isNarrow={false} onOpen={opened} /> : null
}

async function at(address: string, found: RunComparison | Refusal = FOUND) {
  server().on('GET /past-runs/comparison', found)
  history.replaceState(null, '', address)
  const user = show(<Page />)
  await screen.findByText(found instanceof Refusal ? 'These runs cannot be compared' : 'Compare runs')
  return user
}

function row(name: string): HTMLElement {
  const found = screen.getByRole('button', { name }).closest('tr')
  if (!found) throw new Error(name)
  return found
}

beforeEach(() => opened.mockReset())

it('shows visits side by side, and begins at the first divergence', async () => {
  await at('/compare/r1/r2')
  expect(screen.getByText(/First divergence/).closest('div')).toHaveTextContent('failed in the right run (left at 3.00 s, right at 3.50 s)')
  expect(
    within(row('root/move, visit 1'))
      .getAllByRole('cell')
      .map((cell) => cell.textContent),
  ).toEqual(['done', '1.00 s', 'done', '1.50 s', '+0.50 s'])
  expect(
    within(row('root/lift, visit 1'))
      .getAllByRole('cell')
      .map((cell) => cell.textContent),
  ).toEqual(['done', '1.00 s', 'not entered', '', ''])
  expect(row('root/grasp, visit 1')).toHaveAttribute('aria-selected', 'true')
  expect(row('root/grasp, visit 1').querySelector('[data-icon]')).toHaveAttribute('data-icon', 'gripper')
  expect(screen.getByText('wrote force_n').closest('tr')).toHaveTextContent('wrote force_n12.5nothing')
  expect(location.hash).toBe('#root/grasp@1')
})

it('restores the visit of the address, and names the one that is selected', async () => {
  const user = await at('/compare/r1/r2#root/lift@1')
  expect(row('root/lift, visit 1')).toHaveAttribute('aria-selected', 'true')
  await user.click(screen.getByRole('button', { name: 'root/move, visit 1' }))
  expect(location.hash).toBe('#root/move@1')
  expect(screen.getByText('It read and wrote the same values.')).toBeVisible()
  await user.click(screen.getByRole('button', { name: 'Show' }))
  expect(location.hash).toBe('#root/grasp@1')
})

it('lists only what differs, with the selected visit', async () => {
  const user = await at('/compare/r1/r2')
  await user.click(screen.getByRole('switch', { name: 'Only differences' }))
  expect(screen.queryByRole('button', { name: 'root/move, visit 1' })).toBeNull()
  expect(row('root/lift, visit 1')).toBeVisible()
})

it('opens each run at the end of the visit, and swaps both', async () => {
  const user = await at('/compare/r1/r2')
  await user.click(screen.getByRole('link', { name: 'Open the right run there' }))
  await user.click(screen.getByRole('button', { name: 'Swap left and right' }))
  expect(opened.mock.calls).toEqual([['/runs/r2#t=3.5&node=root/grasp'], ['/compare/r2/r1']])
})

it('tells durations, the largest difference first, and settings with the lines of documents', async () => {
  const user = await at('/compare/r1/r2')
  await user.click(screen.getByRole('tab', { name: 'Durations' }))
  const durations = within(screen.getByRole('tabpanel', { name: 'Durations' }))
  expect(durations.getAllByRole('rowheader').map((each) => each.textContent)).toEqual(['root/lift', 'root/move'])
  await user.click(screen.getByRole('tab', { name: /^Settings/ }))
  expect(screen.getByText('parameters.speed').closest('tr')).toHaveTextContent('parameters.speed0.50.7')
  expect(screen.getByLabelText('Lines of pick.yaml')).toHaveTextContent('-speed: 0.5+speed: 0.7')
})

it('names the last good run in the address once it is known', async () => {
  await at(`/compare/${LAST_GOOD}/r2`)
  await waitFor(() => expect(location.pathname).toBe('/compare/r1/r2'))
  expect(row('root/grasp, visit 1')).toHaveAttribute('aria-selected', 'true')
})

it('says where two runs do not diverge, and why two cannot be compared', async () => {
  await at('/compare/r1/r2', { ...FOUND, divergence: null })
  expect(screen.getByText('Both runs visited the same nodes, and each ended in the same way.')).toBeVisible()
  await at('/compare/r1/r3', new Refusal(404, { message: 'there is no run' }))
  expect(screen.getByText(/there is no run/)).toBeVisible()
  goTo('/')
})
