/** Says that the connection is gone, and what happens next. */
import { Alert } from '@mantine/core'
import { IconLock, IconPlugConnectedX } from '@tabler/icons-react'
import { useLive } from '../api/live'

/** The kit's titles have the colour of the alert, which is too faint on its own light ground. */
const READABLE = { title: { color: 'var(--text)' } }

export function Interruption() {
  const connection = useLive((s) => s.connection)
  if (connection === 'denied') {
    return (
      <Alert color="red" variant="light" radius={0} icon={<IconLock size={18} aria-hidden />} title="You are logged out" styles={READABLE} role="alert">
        Your session has ended. Open the address that <code>flexcell login</code> prints, or <a href="/login" target="_blank">log in</a> in
        another tab: this page then goes on, and keeps what is not saved.
      </Alert>
    )
  }
  if (connection === 'lost') {
    return (
      <Alert color="yellow" variant="light" radius={0} icon={<IconPlugConnectedX size={18} aria-hidden />} title="The server does not answer" styles={READABLE} role="alert">
        What you see may be out of date. Trying again; the page goes on by itself once the server is back.
      </Alert>
    )
  }
  return null
}
