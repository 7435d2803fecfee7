/** Another type for nodes: at once where all is kept; else what is lost is shown, and lost only when it is accepted. */
import { screen, waitFor, within } from '@testing-library/react'
import { beforeEach, expect, it } from 'vitest'
import { EDITS, edited, openDocument, sentEdits } from '../../../testing/openDocument'
import { server, show } from '../../../testing/page'
import type { CatalogueBody, TypeLoss } from '../../api/types'
import { machineNode, node } from '../../document/editing/testNodes'
import { choose } from './actions'
import { Palettes } from './Palettes'
import { ReplaceDialog } from './ReplaceDialog'
import { editor } from './store'
import { openReplacePalette, replaceType } from './typeReplacement'

const ROOT = machineNode(
  'root',
  'grasp',
  [node('root/grasp', ['held'], { state: 'test.Give', title: 'test.Give' }), node('root/place', ['done'])],
  [],
)
const TAKE = { kind: 'state', runs: 'test.Take', name: 'take' }
const LOSS: TypeLoss = { path: 'root/grasp', item: 'parameter `force`', value: '3', reason: '`test.Take` has no parameter `force`' }
const DONE = edited(ROOT, { text: 'two', changed: ['root/grasp'] })
const REFUSED = { ...DONE, hash: 'h1', text: 'one', refused: { message: 'it loses', hint: '', index: 0, losses: [LOSS] } }

function state(name: string): object {
  return { name, doc: '', group: 'test', icon: 'state', outcomes: [], parameters: [], inputs: [], outputs: [] }
}

beforeEach(() => {
  const containers = [
    { kind: 'priority', title: 'Priority machine', doc: '', icon: 'shuffle', only_in_tree: false },
    { kind: 'selector', title: 'Selector', doc: '', icon: 'question', only_in_tree: true },
  ]
  const catalogue = { states: [state('test.Give'), state('test.Take')], behaviors: [], containers } as unknown as CatalogueBody
  openDocument(ROOT, { catalogue, answer: DONE })
})

it('offers what a node can be instead, and replaces it at once where nothing is lost', async () => {
  choose(['root/grasp'])
  openReplacePalette()
  const user = show(<Palettes />)
  const names = (await screen.findAllByRole('option')).map((each) => each.textContent ?? '')
  expect(names.filter((name) => name.includes('test.Give') || name.includes('Selector'))).toEqual([])
  await user.click(screen.getByRole('option', { name: /test\.Take/ }))
  await waitFor(() => expect(editor().history.at).toBe(1))
  expect(sentEdits().flat()).toEqual([
    { edit: 'replace_type', paths: ['root/grasp'], kind: 'state', runs: 'test.Take', accepted: [] },
    { edit: 'replace_type', paths: ['root/grasp'], kind: 'state', runs: 'test.Take', accepted: [] },
  ])
})

it('shows what is lost before it is lost, and sends what was shown', async () => {
  server().on(EDITS, REFUSED)
  const user = show(<ReplaceDialog />)
  await replaceType(['root/grasp'], TAKE)
  const lost = await screen.findByRole('table', { name: 'What is lost' })
  expect(within(lost).getByRole('row', { name: /grasp parameter force 3 test.Take has no parameter force/ })).toBeVisible()
  expect(editor().history.at).toBe(0)
  server().on(EDITS, DONE)
  await user.click(screen.getByRole('button', { name: 'Replace' }))
  await waitFor(() => expect(editor().history.at).toBe(1))
  expect(sentEdits().flat().at(-1)).toMatchObject({ accepted: [LOSS] })
  expect(screen.queryByRole('dialog')).toBeNull()
})

it('changes nothing when the losses are not accepted', async () => {
  server().on(EDITS, REFUSED)
  const user = show(<ReplaceDialog />)
  await replaceType(['root/grasp'], TAKE)
  await user.click(await screen.findByRole('button', { name: 'Keep it' }))
  expect(screen.queryByRole('dialog')).toBeNull()
  expect(sentEdits().flat()).toHaveLength(1)
  expect(editor().history.at).toBe(0)
})
