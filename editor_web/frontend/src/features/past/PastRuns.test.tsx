/** The runs of the journal: found by words, days and how they ended; and the recordings of the project. */
import { fireEvent, screen, waitFor } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { PastRunBody, RecordingFile } from '../../api/types'
import { dayEndS, dayStartS } from './days'
import { PastRuns } from './PastRuns'
import { Recordings } from './Recordings'

const opened = vi.fn()
const compared = vi.fn()
const queries: Record<string, string>[] = []

function past(told: Partial<PastRunBody>): PastRunBody {
  return {
    id: 'r1',
    behavior: 'shift',
    document: 'd1',
    status: 'finished',
    outcome: 'good',
    success: true,
    failed: false,
    cause: '',
    started_at_s: 1000,
    duration_s: 2.5,
    events: 40,
    waits: '',
    ticking: false,
    recording: '',
    here: false,
    ...told,
  }
}

const RUNS = [
  past({ recording: 'r1.mcap' }),
  past({ id: 'r2', status: 'running', outcome: null }),
  past({ id: 'r3', failed: true, success: false, outcome: 'bad', cause: 'no contact' }),
]

/** The page, once the server has answered it. */
async function at(runs: readonly PastRunBody[], total = runs.length) {
  queries.length = 0
  opened.mockReset()
  compared.mockReset()
  server().on('GET /past-runs', ({ query }: { query: URLSearchParams }) => {
    queries.push(Object.fromEntries(query))
    return { runs, total, counts: { all: total, failed: 1 } }
  })
  live()
  const user = show(<PastRuns href={(id) => `/runs/${id}`} trendHref={(name) => `/trends/${name}`} onOpen={opened} onCompare={compared} />)
  await waitFor(() => expect(queries).toHaveLength(1))
  return user
}

it('lists the runs with how they ended, and opens one', async () => {
  const user = await at(RUNS)
  const [good, lost, bad] = await screen.findAllByRole('listitem')
  expect(good).toHaveTextContent('Succeeded: good')
  expect(good).toHaveTextContent('2.50 s · 40 events · recorded')
  expect(lost).toHaveTextContent('Interrupted')
  expect(bad).toHaveTextContent('no contact')
  expect(screen.getByRole('button', { name: 'Failed 1' })).toHaveAttribute('aria-pressed', 'false')
  await user.click(screen.getAllByRole('link')[2] ?? document.body)
  expect(opened.mock.calls).toEqual([['/runs/r3']])
})

it('asks for words, days and endings together', async () => {
  const user = await at([])
  expect(await screen.findByText('No past runs')).toBeVisible()
  await user.type(screen.getByLabelText('Find a run'), 'shift bad')
  fireEvent.change(screen.getByLabelText('from'), { target: { value: '2026-03-01' } })
  fireEvent.change(screen.getByLabelText('to'), { target: { value: '2026-03-02' } })
  await user.click(screen.getByRole('button', { name: /^Failed/ }))
  const wanted = { text: 'shift bad', kind: 'failed', since_s: String(dayStartS('2026-03-01')), until_s: String(dayEndS('2026-03-02')) }
  await waitFor(() => expect(queries.at(-1)).toMatchObject(wanted))
  expect(await screen.findByText('No run matches')).toBeVisible()
  expect(screen.getByRole('button', { name: /^Failed/ })).toHaveAttribute('aria-pressed', 'true')
})

it('shows more of many, up to as many as can be looked through', async () => {
  const user = await at(RUNS, 300)
  await user.click(await screen.findByRole('button', { name: 'Show more of 300' }))
  await waitFor(() => expect(queries.at(-1)).toMatchObject({ limit: '100' }))
  await user.click(screen.getByRole('button', { name: 'Show more of 300' }))
  await user.click(screen.getByRole('button', { name: 'Show more of 300' }))
  expect(await screen.findByRole('button', { name: '297 older ones: narrow the search' })).toBeDisabled()
})

it('says why the journal cannot be read', async () => {
  server().on('GET /past-runs', new Refusal(503, { message: 'the journal is locked', hint: 'end the other server' }))
  live()
  show(<PastRuns href={(id) => id} trendHref={(name) => name} onOpen={opened} onCompare={compared} />)
  expect(await screen.findByRole('alert')).toHaveTextContent('the journal is locked – end the other server')
})

it('lists recordings with their size, and why one cannot be opened', async () => {
  opened.mockReset()
  const file: RecordingFile = {
    path: 'runs/a.mcap',
    run: 'r1',
    behavior: 'shift',
    started_at_s: 1000,
    size_bytes: 2_400_000,
    changed_at_s: 1003,
    problem: '',
  }
  server().on('GET /recordings', [file, { ...file, path: 'runs/b.mcap', behavior: '', size_bytes: 10, problem: 'it is cut off' }])
  const user = show(<Recordings href={(path) => `/recordings/${path}`} onOpen={opened} />)
  const [whole, cut] = await screen.findAllByRole('listitem')
  expect(whole).toHaveTextContent('2.4 MB')
  expect(cut).toHaveTextContent('b.mcap')
  expect(cut).toHaveTextContent('1 kB')
  expect(cut).toHaveTextContent('it is cut off')
  await user.click(screen.getByRole('link'))
  expect(opened.mock.calls).toEqual([['runs/a.mcap']])
})

it('says how recordings come to be where there are none', async () => {
  server().on('GET /recordings', [])
  show(<Recordings href={(path) => path} onOpen={opened} />)
  expect(await screen.findByText('No recordings')).toBeVisible()
})

it('compares the two that were ticked last, the older one on the left', async () => {
  const user = await at([past({}), past({ id: 'r2', started_at_s: 900 }), past({ id: 'r3', started_at_s: 950 })])
  const boxes = await screen.findAllByRole('checkbox')
  for (const box of boxes) await user.click(box)
  expect(boxes[0]).not.toBeChecked()
  await user.click(screen.getByRole('button', { name: 'Compare' }))
  expect(compared.mock.calls).toEqual([['r2', 'r3']])
  await user.click(screen.getByRole('button', { name: 'Select none' }))
  // Its place is there before: the list does not move under the pointer.
  expect(screen.getByRole('group', { name: 'Selected runs' })).toHaveTextContent('Select two runs to compare.')
})

it('waits for a second one', async () => {
  const user = await at(RUNS)
  await user.click((await screen.findAllByRole('checkbox'))[0] ?? document.body)
  expect(screen.getByRole('button', { name: 'Compare' })).toBeDisabled()
  expect(screen.getByText('Select a second run.')).toBeVisible()
})

it('compares one with the last good run, and leads to the last runs of its behavior', async () => {
  const user = await at(RUNS)
  await user.click((await screen.findAllByRole('button', { name: /^More of shift/ }))[2] ?? document.body)
  await user.click(await screen.findByRole('menuitem', { name: 'Compare with the last good run' }))
  expect(compared.mock.calls).toEqual([[undefined, 'r3']])
  await user.click(screen.getAllByRole('button', { name: /^More of shift/ })[2] ?? document.body)
  await user.click(await screen.findByRole('menuitem', { name: 'Last runs of shift' }))
  expect(opened.mock.calls).toEqual([['/trends/shift']])
})
