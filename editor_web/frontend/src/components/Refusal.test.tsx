import { screen } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { show } from '../../testing/page'
import { DialogFooter } from './DialogFooter'
import { Refusal } from './Refusal'

it('says what was refused, why, and what to do about it', () => {
  show(
    <Refusal title="Pause was refused:" hint="start a run first">
      no run is active
    </Refusal>,
  )
  expect(screen.getByRole('alert')).toHaveTextContent('Pause was refused: no run is active – start a run first')
  expect(screen.queryByRole('button')).toBeNull()
})

it('draws nothing without a reason', () => {
  show(<Refusal title="Pause was refused:">{''}</Refusal>)
  expect(screen.queryByRole('alert')).toBeNull()
})

it('is put away where somebody can do that', async () => {
  const onClose = vi.fn()
  const user = show(<Refusal onClose={onClose}>no run is active</Refusal>)
  await user.click(screen.getByRole('button', { name: 'Put the refusal away' }))
  expect(onClose).toHaveBeenCalledOnce()
})

it('ends a dialog with the refusal above its buttons, and the one that does it last', async () => {
  const onCancel = vi.fn()
  const user = show(
    <DialogFooter refusal="no reason is given" onCancel={onCancel}>
      <button type="submit">Enable</button>
    </DialogFooter>,
  )
  const [cancel, enable] = screen.getAllByRole('button')
  expect([cancel, enable].map((each) => each?.textContent)).toEqual(['Cancel', 'Enable'])
  const following = screen.getByRole('alert').compareDocumentPosition(cancel ?? document.body)
  expect(following & Node.DOCUMENT_POSITION_FOLLOWING).not.toBe(0)
  await user.click(cancel ?? document.body)
  expect(onCancel).toHaveBeenCalledOnce()
})
