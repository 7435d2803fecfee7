/** The last runs of a behavior: counted once each, durations of the good ones, and two of them compared. */
import { screen } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { server, show } from '../../testing/page'
import type { PastRun, RunTrend } from '../api/types'
import { TrendPage } from './TrendPage'

function run(id: string, started_at_s: number, told: Partial<PastRun> = {}): PastRun {
  return {
    id,
    behavior: 'pick',
    document: 'd',
    status: 'finished',
    outcome: 'good',
    success: true,
    cause: '',
    started_at_s,
    duration_s: 4,
    waits: '',
    ticking: false,
    events: 9,
    ...told,
  }
}

const SPREAD = { count: 2, median_s: 4, lower_s: 3.5, upper_s: 4.5, least_s: 3, most_s: 5, last_s: 6 }
const TREND: RunTrend = {
  behavior: 'pick',
  runs: [run('r3', 30, { success: false, outcome: 'bad', cause: 'no contact', duration_s: 6 }), run('r2', 20), run('r1', 10)],
  known: 8,
  succeeded: 2,
  failed: 1,
  stopped: 0,
  not_ended: 0,
  duration: SPREAD,
  nodes: [{ ...SPREAD, path: 'root/move', last_s: null }],
}

it('counts the runs, and tells durations with the latest run beside them', async () => {
  server().on('GET /past-runs/trend', TREND)
  show(<TrendPage behavior="pick" onOpen={vi.fn()} />)
  expect(await screen.findByText('2 of 3 runs succeeded, 1 failed; the latest of 8')).toBeVisible()
  const [, whole, node] = screen.getAllByRole('row')
  expect(whole).toHaveTextContent('Whole run24.00 s3.50 s to 4.50 s3.00 s5.00 s6.00 s')
  expect(screen.getByTitle('Outside of what the runs that succeeded took')).toHaveTextContent('6.00 s')
  expect(node).toHaveTextContent('root/move24.00 s3.50 s to 4.50 s3.00 s5.00 s–')
})

it('compares the two that are ticked, the older one on the left', async () => {
  const opened = vi.fn()
  server().on('GET /past-runs/trend', TREND)
  const user = show(<TrendPage behavior="pick" onOpen={opened} />)
  const [latest, , oldest] = await screen.findAllByRole('checkbox')
  expect(screen.getByRole('button', { name: 'Compare' })).toBeDisabled()
  await user.click(latest ?? document.body)
  await user.click(oldest ?? document.body)
  await user.click(screen.getByRole('button', { name: 'Compare' }))
  expect(opened.mock.calls).toEqual([['/compare/r1/r3']])
})

it('asks for more runs, and says where none succeeded', async () => {
  const asked: (string | null)[] = []
  server().on('GET /past-runs/trend', ({ query }: { query: URLSearchParams }) => {
    asked.push(query.get('last'))
    return { ...TREND, runs: TREND.runs.slice(0, 1), succeeded: 0, duration: null, nodes: [] }
  })
  const user = show(<TrendPage behavior="pick" onOpen={vi.fn()} />)
  expect(await screen.findByText('None of these runs succeeded')).toBeVisible()
  await user.selectOptions(screen.getByLabelText('Number of runs'), '50')
  expect(await screen.findByText(/^0 of 1 runs succeeded/)).toBeVisible()
  expect(asked).toEqual(['20', '50'])
})
