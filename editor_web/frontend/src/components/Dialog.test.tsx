/** Dialogs: what has the focus when one has gone. */
import { screen } from '@testing-library/react'
import { useState } from 'react'
import { expect, it } from 'vitest'
import { show } from '../../testing/page'
import { Dialog } from './Dialog'

function Opened() {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <button type="button">Other</button>
      <button type="button" onClick={() => setOpen(true)}>
        Save as
      </button>
      <Dialog isOpen={isOpen} title="Save as" onClose={() => setOpen(false)}>
        <input aria-label="Name" />
      </Dialog>
    </>
  )
}

it.each(['{Enter}', ' '])('gives the focus back to the button that opened it when it is closed by %s', async (key) => {
  const user = show(<Opened />)
  await user.click(screen.getByRole('button', { name: 'Save as' }))
  screen.getByLabelText('Close').focus()
  await user.keyboard(key)
  expect(screen.queryByRole('dialog')).toBeNull()
  expect(screen.getByRole('button', { name: 'Save as' })).toHaveFocus()
})
