/** A dialog over the page, and the keyboard after it. */
import { screen, waitFor } from '@testing-library/react'
import { useState } from 'react'
import { expect, it } from 'vitest'
import { show } from '../../testing/page'
import { Dialog } from './Dialog'

function Page() {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <button type="button" onClick={() => setOpen(true)}>
        Open
      </button>
      <Dialog isOpen={isOpen} title="Names" onClose={() => setOpen(false)}>
        <input aria-label="Name" />
      </Dialog>
    </>
  )
}

it('gives the keyboard back to where it was, however it is closed', async () => {
  const user = show(<Page />)
  const open = screen.getByRole('button', { name: 'Open' })
  await user.click(open)
  await user.click(screen.getByRole('textbox', { name: 'Name' }))
  await user.click(screen.getByRole('button', { name: 'Close' }))
  await waitFor(() => expect(open).toHaveFocus())
})
