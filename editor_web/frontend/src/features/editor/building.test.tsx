/** Building on the canvas: what is dropped stays, several nodes are changed at once, and the menu of a node. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { EDITS, edited, openDocument, sentEdits } from '../../../testing/openDocument'
import { server, show } from '../../../testing/page'
import type { CatalogueBody } from '../../api/types'
import { machineNode, node } from '../../document/editing/testNodes'
import { add, choose, moveInto } from './actions'
import { draftFrom } from './apply'
import { setCanvasPositions } from './canvasPositions'
import { DisabledForm } from './DisabledForm'
import { EditHistory } from './EditHistory'
import { Inspector } from './Inspector'
import { NodeMenu } from './NodeMenu'
import { align, layOutSelected } from './placing'
import { setEditor, useEditor } from './store'

const GRASP = node('root/grasp', ['held', 'failed'], { state: 'test.Give', parameters: { speed: 0.2, force: 3 } })
const PLACE = node('root/place', ['done'], { state: 'test.Take', parameters: { speed: 0.5 } })
const INNER = machineNode('root/inner', 'one', [node('root/inner/one', ['done'])], [])
const ROOT = machineNode('root', 'grasp', [GRASP, PLACE, INNER], [['grasp', 'held', 'place']])
const BOX = { width: 100, height: 50 }

function parameter(name: string): object {
  return { name, schema: { type: 'number' }, required: false }
}

const CATALOGUE = {
  states: [
    { name: 'test.Give', doc: '', parameters: [parameter('force'), parameter('speed')], inputs: [], outputs: [] },
    { name: 'test.Take', doc: '', parameters: [parameter('speed')], inputs: [], outputs: [] },
  ],
  behaviors: [],
  containers: [],
} as unknown as CatalogueBody

beforeEach(() => {
  openDocument(ROOT, { catalogue: CATALOGUE })
  const boxes = new Map([
    ['root/grasp', { x: 10, y: 20, ...BOX }],
    ['root/place', { x: 40, y: 30, ...BOX }],
    ['root/inner', { x: 400, y: 20, width: 300, height: 200 }],
    ['root/inner/one', { x: 12, y: 40, ...BOX }],
  ])
  setCanvasPositions({ boxes, outer: new Set(), routes: new Map(), origins: new Map([['root/inner', { x: 4, y: 30 }]]) })
})

it('leaves what is dropped where it was dropped, and its siblings where they are seen', async () => {
  await add({ kind: 'state', runs: 'test.Give', name: 'lift' }, { parent: 'root', at: { x: 222, y: 111 } })
  expect(sentEdits()).toEqual([
    [
      { edit: 'set_positions', positions: { 'root/grasp': [10, 20], 'root/place': [40, 30], 'root/inner': [400, 20] } },
      { edit: 'add_node', parent: 'root', kind: 'state', runs: 'test.Give', name: 'lift', position: [222, 111] },
    ],
  ])
})

it('leaves what is dragged into another container where it was dropped in it', async () => {
  await moveInto(['root/place'], 'root/inner', new Map([['root/place', { x: 120, y: 60 }]]))
  expect(sentEdits()).toEqual([
    [
      { edit: 'move_nodes', paths: ['root/place'], parent: 'root/inner' },
      { edit: 'set_positions', positions: { 'root/inner/one': [8, 10], 'root/inner/place': [120, 60] } },
    ],
  ])
})

it('aligns nodes without laying one on another', async () => {
  choose(['root/grasp', 'root/place'])
  await align('left')
  expect(sentEdits()[0]?.[0]).toMatchObject({ positions: { 'root/grasp': [10, 20], 'root/place': [10, 92] } })
})

it('lays out the selected nodes around where they are, in one step, and leaves the others where they are seen', async () => {
  choose(['root/grasp', 'root/place'])
  await layOutSelected(() => Promise.reject(new Error('a chain needs no engine')))
  const history = useEditor.getState().history
  expect([history.steps.length, history.steps.at(-1)?.label]).toEqual([2, 'Auto-layout of 2 nodes'])
  const [[edit] = []] = sentEdits()
  expect(sentEdits()).toHaveLength(1)
  // Their middle is at 75, 50 before and after.
  expect(edit).toEqual({ edit: 'set_positions', positions: { 'root/grasp': [-54, 25], 'root/place': [104, 25], 'root/inner': [400, 20] } })
})

it('keeps siblings that have no position yet where they are seen, when others are put elsewhere', async () => {
  openDocument({ ...ROOT, children: ROOT.children.map((child) => (child === INNER ? child : { ...child, position: [10, 20] as const })) })
  choose(['root/grasp', 'root/place'])
  await align('column')
  expect(sentEdits()[0]?.[0]).toMatchObject({ positions: { 'root/inner': [400, 20] } })
})

it('says what a selection needs to be laid out', async () => {
  choose(['root/grasp', 'root/inner/one'])
  await layOutSelected()
  expect(sentEdits()).toEqual([])
  expect(useEditor.getState().notice).toMatchObject({ tone: 'refused', message: 'select two nodes or more of one machine' })
})

it('sets a parameter that several nodes have in all of them, disables them, and writes a note on all', async () => {
  const slow = ROOT.children.map((child) => ({ ...child, parameters: { ...child.parameters, speed: 0.3 } }))
  server().on(EDITS, edited({ ...ROOT, children: slow }))
  choose(['root/grasp', 'root/place'])
  const user = show(<Inspector />)
  expect(screen.queryByLabelText('force of all')).toBeNull()
  const speed = screen.getByLabelText('speed of all')
  expect(speed).toHaveAttribute('placeholder', 'different values')
  await user.type(speed, '0.3{Enter}')
  await waitFor(() => expect(sentEdits()).toHaveLength(1))
  await user.click(screen.getByRole('button', { name: 'Disable 2 nodes' }))
  await waitFor(() => expect(sentEdits()).toHaveLength(2))
  await user.type(screen.getByLabelText('The same note on all of them'), 'tune')
  await user.click(screen.getByRole('button', { name: 'Write note' }))
  await waitFor(() => expect(sentEdits()).toHaveLength(3))
  const both = ['root/grasp', 'root/place']
  expect(sentEdits()).toEqual([
    both.map((path) => ({ edit: 'set_parameter', path, name: 'speed', value: 0.3 })),
    both.map((path) => ({ edit: 'set_field', path, field: 'disabled', value: path === 'root/grasp' ? 'held' : 'done' })),
    both.map((path) => ({ edit: 'set_field', path, field: 'notes', value: 'tune' })),
  ])
})

it('disables a node by its form, and says with which outcome it is passed over', async () => {
  const user = show(<DisabledForm node={{ ...GRASP, disabled: 'held' }} />)
  await user.selectOptions(screen.getByLabelText('Passes with'), 'failed')
  await waitFor(() => expect(sentEdits()).toEqual([[{ edit: 'set_field', path: 'root/grasp', field: 'disabled', value: 'failed' }]]))
})

it('opens the menu of a node with what can be done with it', async () => {
  choose(['root/grasp'])
  setEditor({ menu: { x: 5, y: 5 } })
  const user = show(<NodeMenu />)
  const menu = await screen.findByRole('menu')
  expect(within(menu).getByRole('menuitem', { name: /^Rename/ })).toBeVisible()
  await user.click(within(menu).getByRole('menuitem', { name: /^Disable/ }))
  await waitFor(() => expect(sentEdits()).toEqual([[{ edit: 'set_field', path: 'root/grasp', field: 'disabled', value: 'held' }]]))
  expect(useEditor.getState().menu).toBeUndefined()
})

it('lists the edits, and goes to one of them', async () => {
  const first = useEditor.getState().history
  const step = (label: string) => ({
    label,
    draft: { ...(first.steps[0]?.draft ?? draftFrom({ hash: '', graph: ROOT, findings: [], checked: true }, '', undefined)), text: label },
    burst: '',
  })
  setEditor({ history: { steps: [...first.steps, step('Add lift'), step('Rename lift'), step('Delete place')], at: 3 } })
  const user = show(<EditHistory />)
  await user.click(screen.getByRole('button', { name: 'History of edits' }))
  const items = await screen.findAllByRole('menuitem')
  expect(items.map((item) => item.textContent)).toEqual(['Delete place', 'Rename lift', 'Add lift', 'Opened'])
  await user.click(screen.getByRole('menuitem', { name: 'Add lift' }))
  await waitFor(() => expect(useEditor.getState().history.at).toBe(1))
  expect(useEditor.getState().history.steps).toHaveLength(4)
})
