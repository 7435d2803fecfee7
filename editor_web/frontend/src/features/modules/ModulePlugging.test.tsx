/** Plugging a module from the page, and what is asked before a run is stopped for it. */
import { screen, waitFor } from '@testing-library/react'
import { expect, it } from 'vitest'
import { server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import type { LeaseMetrics } from '../../api/types'
import { ModulePlugging } from './ModulePlugging'

const CALL = 'POST /bus/call'
const LEASE: LeaseMetrics = { resource: 'trolley', run: 'carry-1', node: 'root/carry', goal: '', held_s: 3 }

function panel(connector: string, leases: readonly LeaseMetrics[] = []) {
  const user = show(<ModulePlugging module="trolley" />)
  const socket = server().socket('/data')
  socket.accept()
  const value = { modules: [{ module: 'trolley', kind: 'trolley', connector, away: [] }], free: ['north', 'south'] }
  socket.tell({ k: 'message', topic: 'cell/modules', value, problem: '' })
  socket.tell({ k: 'traffic', shape: '1', topics: {}, leases, goals: [] })
  return user
}

it('plugs a module into a connector that is free', async () => {
  server().on(CALL, {})
  const user = panel('')
  expect(screen.getByLabelText('To')).toHaveValue('north')
  await user.click(screen.getByRole('button', { name: 'Plug' }))
  await user.selectOptions(screen.getByLabelText('To'), 'south')
  await waitFor(() => expect(screen.getByRole('button', { name: 'Plug' })).not.toHaveAttribute('aria-disabled'))
  await user.click(screen.getByRole('button', { name: 'Plug' }))
  const plug = (connector: string) => ({ address: 'trolley/plug_module', request: { connector } })
  expect(server().bodies(CALL)).toEqual([plug('north'), plug('south')])
})

it('unplugs a module that nobody has at once, and says why it cannot', async () => {
  server().on(CALL, new Refusal(409, { message: 'arm/hand touches trolley/deck', hint: 'take it away first' }))
  const user = panel('north')
  await user.click(screen.getByRole('button', { name: 'Unplug' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('arm/hand touches trolley/deck – take it away first')
  expect(server().bodies(CALL)).toEqual([{ address: 'trolley/unplug_module', request: {} }])
})

it('names the run that has the module, and stops it only when that is chosen', async () => {
  server().on(CALL, {})
  const user = panel('north', [LEASE])
  await user.click(screen.getByRole('button', { name: 'Unplug…' }))
  expect(screen.getByRole('dialog', { name: 'Unplug trolley?' })).toHaveTextContent('Run carry-1 at root/carry has it')
  await user.click(screen.getByRole('button', { name: 'Cancel' }))
  expect(server().bodies(CALL)).toEqual([])
  await user.click(screen.getByRole('button', { name: 'Unplug…' }))
  await user.click(screen.getByRole('button', { name: 'Stop the run and unplug' }))
  await waitFor(() => expect(screen.queryByRole('dialog')).not.toBeInTheDocument())
  expect(server().bodies(CALL)).toEqual([{ address: 'trolley/unplug_module', request: { end_run: true } }])
})
