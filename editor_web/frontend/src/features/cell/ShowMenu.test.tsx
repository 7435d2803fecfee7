/** What stands around the 3D view: what it shows, the past, and putting the parts back. */
import { act, screen, within } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { usePast } from '../../api/past'
import type { PastViewState } from '../../api/types'
import { PastMark } from './PastMark'
import { ResetParts } from './ResetParts'
import { ShowMenu } from './ShowMenu'

it('tells the server what the view of this page shows, and keeps it in the browser', async () => {
  const socket = live()
  const user = show(<ShowMenu />)
  await user.click(screen.getByRole('button', { name: 'Show' }))
  const menu = within(screen.getByRole('dialog', { name: 'Show' }))
  expect(menu.getByLabelText(/^Voxels/)).toBeChecked()
  expect(menu.getByLabelText(/^Cameras/)).not.toBeChecked()
  await user.click(menu.getByLabelText(/^Voxels/))
  await user.click(menu.getByLabelText(/^Cameras/))
  const groups = ['paths', 'obstacles', 'people', 'detections', 'cameras']
  expect(socket.sent.at(-1)).toMatchObject({ k: 'show', groups })
  expect(JSON.parse(localStorage.getItem('flexcell.layers') ?? '[]')).toEqual(groups)
  await user.keyboard('{Escape}')
  expect(screen.getByRole('button', { name: 'Show' })).toHaveFocus()
})

it('puts the parts back, and says why that was refused', async () => {
  server().on('POST /bus/call', new Refusal(409, { message: 'the arm holds a part' }))
  const user = show(<ResetParts isBusy={false} />)
  await user.click(screen.getByRole('button', { name: 'Reset parts' }))
  expect(await screen.findByText('the arm holds a part')).toBeVisible()
  server().on('POST /bus/call', {})
  await user.click(screen.getByRole('button', { name: 'Reset parts' }))
  expect(await screen.findByText('Parts are back')).toBeVisible()
  expect(server().bodies('POST /bus/call').at(-1)).toEqual({ address: 'cell/reset_parts', request: {} })
})

it('puts no part back while a run is active', () => {
  show(<ResetParts isBusy />)
  expect(screen.getByRole('button', { name: 'Reset parts' })).toBeDisabled()
})

it('says which moment the view shows, that nothing was recorded later, or why it shows the present', () => {
  const drawn: PastViewState = { run: 'r1', time_s: 2, from_s: 0, until_s: 9, problem: '', ghost_problem: '' }
  const at = (told: Partial<PastViewState>) =>
    act(() => usePast.setState({ requested: { run: 'r1', time_s: 2 }, shown: { ...drawn, ...told } }))
  const container = document.body
  show(<PastMark />)
  expect(container).not.toHaveTextContent('r1')
  at({})
  expect(container).toHaveTextContent('2.00 sof r1')
  at({ time_s: 10 })
  expect(container).toHaveTextContent('Recorded until 9.00 s')
  at({ problem: 'nothing was recorded' })
  expect(container).toHaveTextContent('Live: nothing was recorded')
})
