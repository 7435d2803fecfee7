/** Who has the page open is in the header, with what each shows and who operates since when. */
import { act, screen, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, run, show } from '../../../testing/page'
import type { Presence } from '../../api/types'
import { People } from './People'

const ADA: Presence = {
  page: 1,
  name: 'Ada Lovelace',
  role: 'operator',
  document: 'behaviors/palletise.yaml',
  node: 'root/grasp',
  edits: true,
  operates: 'r1',
  since_s: 1000,
}
const OWN: Presence = {
  ...ADA,
  page: 2,
  name: 'Viewer 2',
  role: 'viewer',
  document: '',
  node: '',
  edits: false,
  operates: '',
  since_s: null,
}

it('names the open pages and who operates, and lets one say who one is', async () => {
  const socket = live({ runs: [run({ id: 'r1', behavior: 'behaviors/shift.yaml' })] })
  act(() => socket.tell({ k: 'presence', page: 2, present: [ADA, OWN] }))
  const user = show(<People />)
  expect(screen.getByText('Ada Lovelace operates')).toBeVisible()
  await user.click(screen.getByRole('button', { name: /2 pages open, Ada Lovelace operates/ }))
  const [ada, own] = within(await screen.findByRole('list', { name: 'Open pages' })).getAllByRole('listitem')
  expect(ada).toHaveTextContent('Edits palletise.yaml, grasp selected')
  expect(ada).toHaveTextContent('Operates shift.yaml since')
  expect(own).toHaveTextContent('Viewer 2 (this page)')
  await user.type(screen.getByRole('textbox', { name: 'Your name' }), 'Grace{Enter}')
  expect(socket.sent.at(-1)).toMatchObject({ k: 'present', name: 'Grace' })
})
