/** STOP of the cell: given on both ways, what became of it in words, and who has it. */
import { Modal } from '@mantine/core'
import { act, fireEvent, screen, waitFor } from '@testing-library/react'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { live, server, session, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { api } from '../../api/client'
import type { StopStatus } from '../../api/types'
import { StopCell } from './StopCell'

const STOP = 'http://127.0.0.9:4444/stop'
const CHANNEL = { url: STOP, token: 'stop-token' }
const REASON = 'the cell was stopped in the dashboard'
const ENGINE = 'POST /cell/stop'

function answer(told: Partial<StopStatus> & { readonly atRest?: boolean } = {}): StopStatus {
  const { atRest = true, ...rest } = told
  const devices = [{ name: 'world', connected: true, acknowledged: true, at_rest: atRest }]
  return { stop: 1, reason: REASON, acknowledged: true, at_rest: atRest, engine: 'informed', after_s: 0.01, devices, ...rest }
}

/** The page of somebody, whose server has a stop process or not. */
async function of(told: Parameters<typeof session>[0]) {
  server().on('GET /session', session(told))
  await api.session()
  return show(<StopCell />)
}

function news(): HTMLElement {
  return screen.getByRole('status', { name: 'State of the stop' })
}

async function press(): Promise<void> {
  fireEvent.click(screen.getByRole('button', { name: 'Stop the cell' }))
  await act(() => vi.advanceTimersByTimeAsync(0))
}

beforeEach(() => vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout', 'performance'] }))
afterEach(() => vi.useRealTimers())

it('is given to the stop process and to the engine', async () => {
  server().on(`POST ${STOP}`, answer()).on(ENGINE, {})
  await of({ stop: CHANNEL })
  expect(screen.getByRole('button', { name: 'Stop the cell' })).toHaveAttribute(
    'title',
    expect.stringContaining('This is no emergency stop'),
  )
  await press()
  expect(news()).toHaveTextContent('All arms at rest')
  expect(server().bodies(`POST ${STOP}`)).toEqual([{ token: 'stop-token', reason: REASON }])
  expect(server().bodies(ENGINE)).toEqual([{ reason: REASON }])
})

it('puts its words away by itself, or when it is told to', async () => {
  server().on(ENGINE, {})
  await of({})
  await press()
  expect(news()).toHaveTextContent('All arms at rest')
  await act(() => vi.advanceTimersByTimeAsync(8000))
  expect(news()).toHaveTextContent('')
  await press()
  fireEvent.click(screen.getByRole('button', { name: 'Put the words about the stop away' }))
  expect(news()).toBeEmptyDOMElement()
})

it('is an alarm where an arm does not come to rest', async () => {
  const moving = answer({ atRest: false })
  server()
    .on(`POST ${STOP}`, moving)
    .on(`POST ${STOP}/status`, moving)
    .on(ENGINE, () => new Promise(() => undefined))
  await of({ stop: CHANNEL })
  await press()
  expect(news()).toHaveTextContent('Stop acknowledged')
  expect(screen.queryByRole('alert')).toBeNull()
  await act(() => vi.advanceTimersByTimeAsync(5100))
  expect(screen.getByRole('alert')).toHaveTextContent('not at rest: world')
  server().on(`POST ${STOP}/status`, answer())
  await act(() => vi.advanceTimersByTimeAsync(1000))
  expect(news()).toHaveTextContent('All arms at rest')
})

it('tells that the engine does not answer, though the arms rest', async () => {
  server()
    .on(`POST ${STOP}`, answer({ engine: 'silent' }))
    .on(ENGINE, () => new Promise(() => undefined))
  await of({ stop: CHANNEL })
  await press()
  expect(news()).toHaveTextContent('All arms at rest')
  expect(news()).toHaveTextContent('Engine does not answer')
})

it('says what to press where nobody answers', async () => {
  const gone = () => Promise.reject(new TypeError('Failed to fetch'))
  server().on(`POST ${STOP}`, gone).on(ENGINE, gone)
  await of({ stop: CHANNEL })
  await press()
  expect(screen.getByRole('alert')).toHaveTextContent('STOP has failed')
  expect(screen.getByRole('alert')).toHaveTextContent('Press the emergency stop at the cell')
})

it('is delivered as soon as somebody answers again', async () => {
  const gone = () => Promise.reject(new TypeError('Failed to fetch'))
  server().on(`POST ${STOP}`, gone).on(ENGINE, gone)
  await of({ stop: CHANNEL })
  await press()
  server().on(`POST ${STOP}`, answer())
  await act(() => vi.advanceTimersByTimeAsync(1000))
  expect(news()).toHaveTextContent('All arms at rest')
  await act(() => vi.advanceTimersByTimeAsync(5000))
  expect(server().bodies(`POST ${STOP}`)).toHaveLength(2)
})

it('goes out while another request hangs and the live stream is down', async () => {
  server()
    .on('GET /behaviors', () => new Promise(() => undefined))
    .on(`POST ${STOP}`, answer())
    .on(ENGINE, () => new Promise(() => undefined))
  await of({ stop: CHANNEL })
  void api.behaviors()
  live().cut()
  await press()
  expect(news()).toHaveTextContent('All arms at rest')
})

it('is reached by Tab out of a dialog that keeps the keyboard, and is pressed above it', async () => {
  vi.useRealTimers()
  server().on(ENGINE, {}).on('GET /session', session({}))
  await api.session()
  const user = show(
    <>
      <StopCell />
      <Modal
        opened
        onClose={() => undefined}
        title="A question"
        closeButtonProps={{ 'aria-label': 'Close' }}
        transitionProps={{ duration: 0 }}
      >
        <button type="button">Yes</button>
      </Modal>
    </>,
  )
  const yes = await screen.findByRole('button', { name: 'Yes' })
  yes.focus()
  await user.tab()
  expect(screen.getByRole('button', { name: 'Stop the cell' })).toHaveFocus()
  await user.keyboard('{Enter}')
  await waitFor(() => expect(server().bodies(ENGINE)).toHaveLength(1))
  await user.tab()
  expect(screen.getByRole('button', { name: 'Close' })).toHaveFocus()
  await user.tab({ shift: true })
  expect(screen.getByRole('button', { name: 'Stop the cell' })).toHaveFocus()
})

it('is an alarm where nobody has acknowledged it in time', async () => {
  server().on(ENGINE, () => new Promise(() => undefined))
  await of({})
  await press()
  expect(news()).toHaveTextContent('Stopping')
  await act(() => vi.advanceTimersByTimeAsync(1500))
  expect(screen.getByRole('alert')).toHaveTextContent('STOP is not acknowledged')
})

it('has a key that works while somebody writes, once for each press', async () => {
  server().on(ENGINE, new Refusal(500, { message: 'broken' }))
  await of({})
  const key = { key: 'Backspace', ctrlKey: true, shiftKey: true }
  const field = document.body.appendChild(document.createElement('input'))
  fireEvent.keyDown(field, key)
  fireEvent.keyDown(field, { ...key, repeat: true })
  await act(() => vi.advanceTimersByTimeAsync(0))
  field.remove()
  expect(server().bodies(ENGINE)).toHaveLength(1)
})

it('is not there for a viewer, nor is its key', async () => {
  await of({ role: 'viewer' })
  fireEvent.keyDown(document.body, { key: 'Backspace', ctrlKey: true, shiftKey: true })
  await act(() => vi.advanceTimersByTimeAsync(0))
  expect(screen.queryByRole('button', { name: 'Stop the cell' })).toBeNull()
  expect(server().bodies(ENGINE)).toEqual([])
})

it('stands on a page that is logged out', async () => {
  await of({ stop: CHANNEL })
  server().on('GET /session', new Refusal(401, {}))
  await act(async () => void (await api.session().catch(() => undefined)))
  expect(screen.getByRole('button', { name: 'Stop the cell' })).toBeEnabled()
})
