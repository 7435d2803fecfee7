/** The duration of a run: the same wherever it is shown, and from wherever it was read. */
import { act, screen } from '@testing-library/react'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { control, live, run, show } from '../../testing/page'
import { useLive } from '../api/live'
import { StatusRow } from '../features/control/StatusRow'
import { useCommands } from '../features/control/useCommands'
import { RunTime } from '../components/RunTime'

beforeEach(() => vi.useFakeTimers({ toFake: ['performance', 'setInterval', 'clearInterval'] }))
afterEach(() => vi.useRealTimers())

/** As lists, the row of states and the journal show it; the journal knows it up to its last event. */
function Views({ lastEventS }: { readonly lastEventS: number }) {
  const shownRun = useLive((s) => s.runs[0])
  const commands = useCommands(shownRun, undefined)
  if (!shownRun) return null
  return (
    <>
      <p aria-label="list">
        <RunTime run={shownRun} />
      </p>
      <p aria-label="journal">
        <RunTime run={{ ...shownRun, behavior: 'shift', duration_s: lastEventS } as typeof shownRun} />
      </p>
      <StatusRow run={shownRun} root={null} commands={commands} onShow={() => undefined} />
    </>
  )
}

function shown(): (string | null)[] {
  const row = screen.getByRole('status', { name: 'State of the run' }).parentElement?.lastElementChild
  return [screen.getByLabelText('list').textContent, screen.getByLabelText('journal').textContent, row?.textContent ?? null]
}

it('goes on from what was told while the run does, also of a run that is not watched', () => {
  const socket = live({ runs: [run({ duration_s: 5, ticking: true })] })
  show(<Views lastEventS={2} />)
  expect(shown()).toEqual(['5.00 s', '5.00 s', '5.00 s'])
  pass(3000)
  expect(shown()).toEqual(['8.00 s', '8.00 s', '8.00 s'])
  // A paused run stands, and when it goes on, the pause counts.
  act(() => told(socket, { duration_s: 9, waits: 'paused', ticking: false }))
  pass(3000)
  expect(shown()).toEqual(['9.00 s', '9.00 s', '9.00 s'])
  act(() => told(socket, { duration_s: 12.5, ticking: true }))
  pass(1000)
  expect(shown()).toEqual(['13.5 s', '13.5 s', '13.5 s'])
})

it('is that of its last event when it has ended', () => {
  live({ runs: [run({ status: 'finished', outcome: 'good', success: true, duration_s: 7.5 })] })
  show(<Views lastEventS={7.5} />)
  pass(3000)
  expect(shown()).toEqual(['7.50 s', '7.50 s', '7.50 s'])
})

it('is not the moment of the timeline that is shown', () => {
  live({ run: 'r1', runs: [run({ duration_s: 5, ticking: true })], now_s: 5, ticking: true, control: control() })
  show(<Views lastEventS={2} />)
  pass(1000)
  expect(shown()).toEqual(['6.00 s', '6.00 s', '6.00 s'])
  act(() => useLive.setState({ past: { run: 'r1', nowS: 1 } as never, nowS: 1, ticking: false }))
  pass(1000)
  expect(shown()).toEqual(['7.00 s', '7.00 s', '7.00 s'])
})

function pass(ms: number): void {
  act(() => {
    vi.advanceTimersByTime(ms)
  })
}

function told(socket: ReturnType<typeof live>, change: Parameters<typeof run>[0]): void {
  socket.tell({
    k: 'delta',
    run: '',
    after: 1,
    seq: 1,
    now_s: 0,
    ticking: false,
    runs: [run(change)],
    nodes: {},
    log: [],
    dropped: 0,
    control: null,
    lock_reasons: {},
    robots: {},
  })
}
