/** The jog panel: every press of every kind of input is told from its beginning to its end; waiting and blocks are said. */
import { act, cleanup, fireEvent, screen } from '@testing-library/react'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { armInfo, live, server, session, show } from '../../../testing/page'
import type { FakeSocket } from '../../../testing/server'
import { connectTeach } from '../../api/teaching'
import { TOOL_AXES } from '../../document/teaching'
import { JogPanel } from './JogPanel'

const LEFT = armInfo({ tool: 'hand' })
const NOW = { mode: 'idle', activity: '', error: '', joints: [0, 0.5], tool_pose: [0.4, 0, 0.3, 0, 0, 0, 1], tool: null }
/** Of each kind of input: a hundred together. */
const PRESSES = 25
const MM_S = [0.05, 0.05, 0.05, 0.2, 0.2, 0.2] as const
let disconnect: () => void = () => undefined

function opened(): FakeSocket {
  server().on('GET /session', session({ role: 'operator' }))
  live({}, 'operator')
  disconnect = connectTeach()
  const socket = server().socket('/teach/live')
  socket.accept()
  socket.tell({ k: 'arms', arms: [LEFT], can_push: false, frames: ['world'] })
  show(<JogPanel arm={LEFT} />)
  socket.tell({ k: 'now', arms: { left: NOW } })
  return socket
}

function prepared(): FakeSocket {
  const socket = opened()
  socket.tell({ k: 'ready', arm: 'left', ready: true, reason: '' })
  return socket
}

/** Axes and signs that look random and are the same each time. */
function changes(): readonly (readonly [axis: number, sign: 1 | -1])[] {
  let state = 7
  const next = (below: number) => {
    state = (state * 1103515245 + 12345) % 2147483648
    return Math.floor((state / 2147483648) * below)
  }
  return Array.from({ length: PRESSES }, () => [next(6), next(2) === 0 ? 1 : -1] as const)
}

function velocityOf([axis, sign]: readonly [number, 1 | -1]): readonly unknown[] {
  return MM_S.map((full, at): unknown => (at === axis ? expect.closeTo(sign * full) : expect.closeTo(0)))
}

/** The presses that the server is told: each from `jog` over one `go` or more to `rest`. */
function pressesOf(sent: readonly unknown[]): readonly (readonly unknown[])[] {
  const presses: unknown[][] = []
  for (const message of sent as readonly { readonly k: string }[]) {
    if (message.k === 'jog') presses.push([])
    if (message.k !== 'go' || presses.at(-1)?.length === 1) presses.at(-1)?.push(message)
  }
  return presses
}

function expected(told: readonly (readonly [number, 1 | -1])[]): readonly (readonly unknown[])[] {
  const jog = { k: 'jog', arm: 'left', space: 'tool', frame: 'world' }
  return told.map((change) => [jog, { k: 'go', velocity: velocityOf(change) }, { k: 'rest' }])
}

function button([axis, sign]: readonly [number, 1 | -1]): HTMLElement {
  return screen.getByLabelText(`${TOOL_AXES[axis]} ${sign > 0 ? 'plus' : 'minus'}`)
}

beforeEach(() => {
  vi.useFakeTimers({ toFake: ['setInterval', 'clearInterval'] })
})

afterEach(() => {
  vi.useRealTimers()
  vi.restoreAllMocks()
  disconnect()
})

it.each(['mouse', 'touch'])('tells each press of a seeded sequence by %s', (pointerType) => {
  const socket = prepared()
  const pressed = changes()
  const begun = socket.sent.length
  for (const change of pressed) {
    const key = button(change)
    fireEvent.pointerDown(key, { pointerId: 1, button: 0, pointerType })
    fireEvent.pointerUp(key, { pointerId: 1, button: 0, pointerType })
  }
  expect(pressesOf(socket.sent.slice(begun))).toEqual(expected(pressed))
})

it('tells each press of a seeded sequence by keyboard', () => {
  const socket = prepared()
  const keys = ['Arrow', 'ArrowUp', 'ArrowDown', 'ArrowLeft', 'ArrowRight', 'PageUp', 'PageDown']
  const pressed = changes()
  const begun = socket.sent.length
  const field = screen.getByRole('button', { name: /Jog with the keyboard/ })
  for (const [axis, sign] of pressed) {
    const key = keys[1 + (axis % 3) * 2 + (sign > 0 ? 0 : 1)] ?? ''
    fireEvent.keyDown(field, { key, shiftKey: axis > 2 })
    fireEvent.keyDown(field, { key, shiftKey: axis > 2, repeat: true })
    fireEvent.keyUp(field, { key })
  }
  expect(pressesOf(socket.sent.slice(begun))).toEqual(expected(pressed))
})

it('tells each press of a seeded sequence by gamepad', () => {
  const pad = { index: 0, connected: true, axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, () => ({ pressed: false })) }
  const look = () => act(() => void vi.advanceTimersByTime(45))
  vi.spyOn(navigator, 'getGamepads').mockReturnValue([pad as unknown as Gamepad])
  vi.spyOn(document, 'hasFocus').mockReturnValue(true)
  const socket = prepared()
  fireEvent.click(screen.getByLabelText(/^Jog with a gamepad/))
  const pressed = changes()
  const begun = socket.sent.length
  for (const [axis, sign] of pressed) {
    look()
    pad.buttons[4] = { pressed: true }
    pad.buttons[5] = { pressed: axis > 2 }
    // Left and up are the positive ways: X is the left stick upright, Y the same across, Z the right one upright.
    pad.axes = [0, 0, 0, 0].map((_, stick) => (stick === ([1, 0, 3][axis % 3] ?? 0) ? -sign : 0))
    look()
    pad.buttons[4] = { pressed: false }
    pad.axes = [0, 0, 0, 0]
    look()
  }
  expect(pressesOf(socket.sent.slice(begun))).toEqual(expected(pressed))
})

it('waits visibly until the arm is prepared, and again after a stop', () => {
  const socket = opened()
  const state = screen.getByRole('status', { name: 'State of jogging' })
  expect(socket.sent).toEqual([{ k: 'prepare', arm: 'left' }])
  expect(state).toHaveTextContent('Preparing')
  expect(button([2, 1])).toHaveAttribute('aria-disabled', 'true')
  fireEvent.keyDown(button([2, 1]), { key: 'Enter' })
  expect(socket.sent).toHaveLength(1)
  socket.tell({ k: 'ready', arm: 'left', ready: true, reason: '' })
  expect(state).not.toHaveTextContent('Preparing')
  expect(button([2, 1])).not.toHaveAttribute('aria-disabled')
  socket.tell({ k: 'ready', arm: 'left', ready: false, reason: '' })
  expect(state).toHaveTextContent('Preparing')
  socket.tell({ k: 'ready', arm: 'left', ready: false, reason: 'the planning process does not start' })
  expect(state).toHaveTextContent('the planning process does not start')
  expect(button([2, 1])).not.toHaveAttribute('aria-disabled')
})

it('says that a press was dropped until the next one, and lets go of nothing', () => {
  const socket = prepared()
  const state = screen.getByRole('status', { name: 'State of jogging' })
  fireEvent.pointerDown(button([2, 1]), { pointerId: 1, button: 0 })
  const held = socket.sent.length
  socket.tell({ k: 'dropped', arm: 'left', within_s: 0.3 })
  expect(state).toHaveTextContent('could not move within 0.3 s of its release')
  expect(socket.sent).toHaveLength(held)
  fireEvent.pointerUp(button([2, 1]), { pointerId: 1, button: 0 })
  fireEvent.pointerDown(button([2, -1]), { pointerId: 1, button: 0 })
  expect(state).not.toHaveTextContent('dropped')
})

it('lets the server prepare nothing any more once it is hidden', () => {
  const socket = prepared()
  cleanup()
  expect(socket.sent.at(-1)).toEqual({ k: 'prepare', arm: '' })
})

it('says what the arm stands before, how near, and which ways lead out, until it goes free', () => {
  const socket = prepared()
  const state = screen.getByRole('status', { name: 'State of jogging' })
  const directions_out = [
    { axis: 2, sign: 1 },
    { axis: 3, sign: -1 },
  ]
  const block = { k: 'block', robot: 'left', first: 'left/panda_hand', second: 'table', distance_m: 0.0062, directions_out }
  socket.tell({ ...block, distance_m: null, directions_out: [] })
  expect(state.textContent).toBe('left/panda_hand stands before table.')
  socket.tell(block)
  expect(state).toHaveTextContent('left/panda_hand stands 6.2 mm before table. Directions out: Z plus, RX minus.')
  socket.tell({ ...block, first: '', second: '', directions_out: [] })
  expect(state).toHaveTextContent('')
  socket.tell({ ...block, directions_out: [] })
  expect(state).toHaveTextContent('No direction leads out')
  // The directions are those of the axes in which it was jogged.
  fireEvent.click(screen.getByRole('radio', { name: 'Joints' }))
  expect(state).not.toHaveTextContent('stands')
})
