/** The outline, the way into the graph for keyboard and screen reader, and the facts of what is chosen in it. */
import { screen } from '@testing-library/react'
import { useState } from 'react'
import { expect, it } from 'vitest'
import { graphNode, live, node, run, show, snapshot } from '../../../testing/page'
import type { GraphNode } from '../../api/types'
import { nodeAt } from '../../document/tree'
import { Outline } from './Outline'
import { Selection } from './Selection'

function part(path: string, told: Partial<GraphNode> = {}): GraphNode {
  return graphNode(path, { title: 'motion.MoveJoints', outcomes: ['reached', 'failed'], ...told })
}

const APPROACH = part('root/approach', {
  kind: 'concurrency',
  title: '',
  conditions: ['there: left reached and right reached'],
  children: [part('root/approach/left'), part('root/approach/right')],
})
const REST = part('root/rest', { title: 'flow.Wait', icon: 'flow' })
const ROOT = part('root', { kind: 'machine', title: '', icon: 'sitemap', children: [APPROACH, REST] })

function Both() {
  const [selected, setSelected] = useState<string>()
  const chosen = selected ? nodeAt(ROOT, selected) : undefined
  return (
    <>
      <Outline root={ROOT} selected={selected} onSelect={setSelected} />
      {chosen && <Selection node={chosen} />}
    </>
  )
}

function item(name: RegExp): HTMLElement {
  return screen.getByRole('treeitem', { name })
}

it('is worked by the arrow keys, and chooses with Enter', async () => {
  live({ run: 'r1', runs: [run()], nodes: { 'root/approach/left': node() } })
  const user = show(<Both />)
  await user.tab()
  expect(item(/^root/)).toHaveFocus()
  await user.keyboard('{ArrowRight}{ArrowRight}{Enter}')
  expect(screen.getByRole('treeitem', { selected: true })).toHaveAccessibleName('left motion.MoveJoints active')
  expect(screen.getByRole('region', { name: 'Selected: left' })).toHaveTextContent('Runsmotion.MoveJoints')
  await user.keyboard('{ArrowLeft}{ArrowLeft}')
  expect(item(/^approach/)).toHaveAttribute('aria-expanded', 'false')
  expect(screen.queryByRole('treeitem', { name: /^right/ })).toBeNull()
  await user.keyboard('{ArrowRight}{End}')
  expect(item(/^rest/)).toHaveFocus()
  await user.keyboard('{ArrowUp} ')
  expect(screen.getByRole('treeitem', { selected: true })).toHaveAccessibleName(/^right/)
  await user.keyboard('{Home}')
  expect(item(/^root/)).toHaveFocus()
})

it('has one stop for Tab, at what was reached last', async () => {
  live()
  const user = show(<Both />)
  await user.tab()
  await user.keyboard('{ArrowDown}')
  const stops = screen.getAllByRole('treeitem').filter((each) => each.tabIndex === 0)
  expect(stops).toEqual([item(/^approach/)])
})

it('tells levels, states and visits, as they change', () => {
  const socket = live({ run: 'r1', runs: [run()], nodes: { 'root/rest': node() } })
  show(<Both />)
  expect(item(/^left/)).toHaveAttribute('aria-level', '3')
  expect(item(/^rest/)).toHaveAccessibleName('rest flow.Wait active')
  expect([/^root/, /^rest/].map((name) => item(name).querySelector('[data-icon]')?.getAttribute('data-icon'))).toEqual(['sitemap', 'flow'])
  socket.tell(snapshot({ run: 'r1', runs: [run()], nodes: { 'root/rest': node({ status: 'done', outcome: 'done', visits: 2 }) } }))
  expect(item(/^rest/)).toHaveAccessibleName('rest flow.Wait done: done ×2')
})

it('tells of a chosen node what it is, how long it took, and why it failed', async () => {
  const failed = node({ status: 'failed', outcome: 'failed', visits: 3, duration_s: 1.5, cause: 'no contact on either pad' })
  live({ run: 'r1', runs: [run()], nodes: { 'root/rest': failed } })
  const user = show(<Both />)
  await user.click(item(/^rest/))
  const facts = screen.getByRole('region', { name: 'Selected: rest' })
  expect(facts).toHaveTextContent('failed')
  expect(facts).toHaveTextContent('Outcomesreached, failed')
  expect(facts).toHaveTextContent('Visits3')
  expect(facts).toHaveTextContent('Time1.50 s')
  expect(facts).toHaveTextContent('Causeno contact on either pad')
  await user.click(item(/^approach/))
  expect(screen.getByRole('region', { name: 'Selected: approach' })).toHaveTextContent('Endsthere: left reached and right reached')
})
