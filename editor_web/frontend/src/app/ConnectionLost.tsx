/** Says that the connection is gone, and what happens next. */
import { Alert } from '@mantine/core'
import { IconPlugConnectedX } from '@tabler/icons-react'
import { useLive } from '../api/live'
import { READABLE_TITLE } from '../components/alertStyles'

export function ConnectionLost() {
  const connection = useLive((s) => s.connection)
  if (connection === 'lost') {
    return (
      <Alert
        color="yellow"
        variant="light"
        radius={0}
        icon={<IconPlugConnectedX size={18} aria-hidden />}
        title="The server does not answer"
        styles={READABLE_TITLE}
        role="alert"
      >
        What you see may be out of date. STOP still works. Trying again; the page goes on by itself once the server is back.
      </Alert>
    )
  }
  return null
}
