/** Usages: where behaviors use something, by document; each place leads to its node. */
import { screen, within } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, server, show } from '../../../testing/page'
import type { Usage, Usages } from '../../api/types'
import type { Used } from '../../document/editing/usedBy'
import { UsagesDialog } from './UsagesDialog'

const opened = vi.fn()
const STATES = [{ name: 'motion.MoveJoints' }, { name: 'gripper.Grasp' }]

function usage(document: string, path: string, line: number, how = 'runs'): Usage {
  return { document, behavior: document.replace('.yaml', ''), path, how, line, column: 5 }
}

function asked(used: Used, found: Usages['found'], unread: Usages['unread'] = []) {
  opened.mockReset()
  live()
  server()
    .on('GET /catalogue', { states: STATES, containers: [], behaviors: [], entries: [{ kind: 'joints', name: 'home' }], names: {} })
    .on('GET /search/usages', ({ query }: { query: URLSearchParams }) =>
      query.get('name') === used.name ? { found, unread } : { found: [], unread: [] },
    )
  return show(<UsagesDialog asked={used} onOpen={opened} />)
}

it('lists the places of each document with file and line, and leads to them', async () => {
  const found = [usage('a/shift.yaml', 'root/home', 11), usage('a/shift.yaml', 'root/more', 17), usage('b.yaml', 'root/x/child', 4)]
  const user = asked({ kind: 'state', name: 'motion.MoveJoints' }, found, ['broken.yaml'])
  expect(await screen.findByText('3 places in 2 documents')).toBeVisible()
  const shift = screen.getByRole('region', { name: 'a/shift.yaml' })
  expect(
    within(shift)
      .getAllByRole('listitem')
      .map((each) => each.textContent),
  ).toEqual(['root/homerunsshift.yaml:11', 'root/morerunsshift.yaml:17'])
  expect(screen.getByText(/These cannot be read.*broken\.yaml/)).toBeVisible()
  await user.click(screen.getByRole('button', { name: /^root\/x\/child, / }))
  expect(opened.mock.calls).toEqual([['b.yaml', 'root/x/child']])
})

it('looks for something else that is typed, of another kind', async () => {
  const user = asked({ kind: 'entry', name: 'home' }, [usage('b.yaml', 'root/x', 4, 'reads joints')])
  expect(await screen.findByText('One place in one document')).toBeVisible()
  await user.click(screen.getByLabelText('Userdata key'))
  expect(screen.getByText('Of which one?')).toBeVisible()
  await user.type(screen.getByRole('combobox', { name: 'Its name' }), 'tries')
  expect(await screen.findByText('Nothing uses it.')).toBeVisible()
})
