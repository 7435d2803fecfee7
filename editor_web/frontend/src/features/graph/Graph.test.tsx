/** The graph of a run: where its nodes are does not depend on the window, and its view goes with the run until it is moved. */
import { act, screen, waitFor } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { graphNode, live, node, run, show, snapshot } from '../../../testing/page'
import type { Presence } from '../../api/types'
import { Graph } from './Graph'

const NAMES = ['home', 'look', 'approach', 'grasp', 'lift', 'carry', 'place', 'retreat']
const ROOT = graphNode('root', {
  kind: 'machine',
  outcomes: ['finished'],
  initial: 'home',
  children: NAMES.map((name) => graphNode(`root/${name}`)),
  transitions: NAMES.map((source, index) => ({ source, outcome: 'a', target: NAMES[index + 1] ?? 'finished' })),
})

afterEach(() => vi.unstubAllGlobals())

/** Whatever is measured is this large. */
function paneOf(width: number, height: number): void {
  vi.stubGlobal(
    'ResizeObserver',
    class {
      constructor(private readonly told: ResizeObserverCallback) {}
      observe(target: Element): void {
        const contentRect = { width, height, x: 0, y: 0, top: 0, left: 0, right: width, bottom: height } as DOMRectReadOnly
        queueMicrotask(() => act(() => this.told([{ target, contentRect } as ResizeObserverEntry], this as unknown as ResizeObserver)))
      }
      unobserve(): void {}
      disconnect(): void {}
    },
  )
}

function graph() {
  return <Graph root={ROOT} selected={undefined} onSelect={() => undefined} shown={undefined} breadcrumb={null} />
}

const SIZES = [
  [240, 160],
  [500, 1400],
  [1600, 300],
  [3840, 2160],
] as const

it.each(SIZES)('puts its nodes at the same places in a panel of %i x %i', async (width, height) => {
  paneOf(width, height)
  show(graph())
  await waitFor(() => expect(document.querySelectorAll('.react-flow__node').length).toBe(NAMES.length + 2))
  const places = NAMES.map((name) => document.querySelector<HTMLElement>(`[data-id="root/${name}"]`)?.style.transform)
  expect(new Set(places).size).toBe(NAMES.length)
  // Five in a row, and what follows below them.
  expect(places.map((place) => /, ?([\d.]+)px\)/.exec(place ?? '')?.[1])).toEqual(
    places.map((_, index) => (index < 5 ? FIRST_ROW : SECOND_ROW)),
  )
})

const FIRST_ROW = '44'
const SECOND_ROW = '152'

it('follows the run by default; what a person looks at pauses it, and Follow resumes it', async () => {
  paneOf(600, 300)
  const socket = live({ run: 'r1', runs: [run()], nodes: { 'root/look': node() } })
  const user = show(graph())
  const follows = await screen.findByRole('button', { name: 'Follow the active nodes' })
  expect(follows.getAttribute('aria-pressed')).toBe('true')
  await user.click(screen.getByRole('button', { name: 'Zoom out' }))
  expect(follows.getAttribute('aria-pressed')).toBe('false')
  await user.click(await screen.findByRole('button', { name: 'Follow' }))
  expect(follows.getAttribute('aria-pressed')).toBe('true')
  await user.click(screen.getByRole('button', { name: 'Show all' }))
  // A further run is followed again.
  act(() => socket.tell(snapshot({ run: 'r2', seq: 2, runs: [run({ id: 'r2' })], nodes: { 'root/look': node() } })))
  expect(follows.getAttribute('aria-pressed')).toBe('true')
})

it('shows the kind of each node by its icon', async () => {
  paneOf(1600, 800)
  const children = [graphNode('root/home', { icon: 'path' }), graphNode('root/look', { icon: 'camera' })]
  const root = graphNode('root', { kind: 'machine', icon: 'sitemap', initial: 'home', children })
  show(<Graph root={root} selected={undefined} onSelect={() => undefined} shown={undefined} breadcrumb={null} />)
  await waitFor(() => expect(document.querySelectorAll('[data-icon]').length).toBe(3))
  expect(
    Object.fromEntries([...document.querySelectorAll('[data-icon]')].map((each) => [nodeOf(each), each.getAttribute('data-icon')])),
  ).toEqual({ root: 'sitemap', 'root/home': 'path', 'root/look': 'camera' })
})

const GRACE: Presence = {
  page: 2,
  name: 'Grace Hopper',
  role: 'viewer',
  document: 'behaviors/shift.yaml',
  node: 'root/look',
  edits: false,
  operates: '',
  since_s: null,
}

it('shows who else has a node selected, also inside of a collapsed container', async () => {
  paneOf(1600, 800)
  const children = ['left', 'right'].map((name) => graphNode(`root/look/${name}`))
  const look = graphNode('root/look', { kind: 'concurrency', children })
  const root = { ...ROOT, children: ROOT.children.map((child) => (child.path === look.path ? look : child)) }
  const socket = live({ run: 'r1', runs: [run()] })
  const user = show(
    <Graph root={root} selected={undefined} onSelect={() => undefined} shown={undefined} breadcrumb={null} document={GRACE.document} />,
  )
  await screen.findByRole('button', { name: 'Collapse look' })
  const people = (...present: Presence[]) => act(() => socket.tell({ k: 'presence', page: 1, present }))
  people(GRACE)
  expect(nodeOf(screen.getByTitle('Grace Hopper has it selected'))).toBe('root/look')
  expect(screen.getByText('GH')).toBeVisible()
  // What she has of another behavior, and what this page has itself, is not marked.
  people({ ...GRACE, document: 'behaviors/other.yaml' }, { ...GRACE, page: 1 })
  expect(screen.queryByTitle('Grace Hopper has it selected')).toBeNull()
  people({ ...GRACE, node: 'root/look/left' })
  expect(nodeOf(screen.getByTitle('Grace Hopper has it selected'))).toBe('root/look/left')
  screen.getByRole('button', { name: 'Collapse look' }).focus()
  await user.keyboard('{Enter}')
  await waitFor(() => expect(nodeOf(screen.getByTitle('Grace Hopper has it selected'))).toBe('root/look'))
})

function nodeOf(part: Element): string | undefined {
  return part.closest<HTMLElement>('.react-flow__node')?.dataset['id']
}
