/** The search of the page: what the server finds by name, and the commands and nodes of the page that is shown. */
import { screen, waitFor } from '@testing-library/react'
import { afterEach, expect, it, vi } from 'vitest'
import { server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { offerCommands, pageCommands } from '../../api/search'
import type { NameHit } from '../../api/types'
import { SearchBox } from './SearchBox'

const NODE: NameHit = {
  kind: 'node',
  id: 'behaviors/a.yaml',
  path: 'root/grasp',
  title: 'grasp',
  detail: 'gripper.Grasp · a',
  icon: 'gripper',
}
const RUN: NameHit = { kind: 'run', id: 'r1', path: '', title: 'grasping', detail: 'r1 finished', icon: '' }
const opened = vi.fn()
const home = vi.fn()
const PAGES = [{ id: 'page:/', title: 'Home', group: 'Pages', run: home }]

function search(edited?: string) {
  return show(<SearchBox pages={PAGES} edited={edited} onOpen={opened} />)
}

afterEach(() => {
  opened.mockReset()
})

it('shows what the server finds, by kind, and leads there by the keyboard', async () => {
  server().on('GET /search', [NODE, RUN])
  const user = search()
  await user.type(screen.getByRole('combobox', { name: 'Search' }), 'gra')
  expect(await screen.findByText('gripper.Grasp · a')).toBeInTheDocument()
  expect(screen.getByText('grasping')).toBeInTheDocument()
  expect(screen.getByRole('option', { name: /gripper.Grasp/ }).querySelector('[data-icon]')).toHaveAttribute('data-icon', 'gripper')
  await user.keyboard('{Enter}')
  await waitFor(() => expect(opened.mock.calls).toEqual([[NODE]]))
})

it('offers the commands of the page; one that cannot be used now says why', async () => {
  // The search is asked where the pause between keys is long enough.
  server().on('GET /search', [])
  const undo = vi.fn()
  const end = offerCommands(() => [
    { id: 'command:undo', title: 'Undo', group: 'Commands', hint: 'Ctrl Z', obstacle: 'nothing was changed', run: undo },
  ])
  const user = search()
  await user.type(screen.getByRole('combobox', { name: 'Search' }), 'un')
  const option = screen.getByRole('option', { name: /Undo/ })
  expect(option).toHaveAttribute('title', 'nothing was changed')
  await user.click(option)
  expect(undo).not.toHaveBeenCalled()
  end()
  expect(pageCommands()).toEqual([])
})

it('leaves the nodes of the behavior that is edited to the editor', async () => {
  server().on('GET /search', [NODE, RUN])
  const user = search(NODE.id)
  await user.type(screen.getByRole('combobox', { name: 'Search' }), 'gra')
  expect(await screen.findByText('grasping')).toBeInTheDocument()
  expect(screen.queryByText('gripper.Grasp · a')).toBeNull()
})

it('says why nothing was found', async () => {
  server().on('GET /search', new Refusal(503, { message: 'the server is too busy', hint: 'try again' }))
  const user = search()
  await user.type(screen.getByRole('combobox', { name: 'Search' }), 'gra')
  expect(await screen.findByText(/the server is too busy/)).toBeInTheDocument()
})
