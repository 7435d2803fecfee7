/** Why the server, or the page itself, refused the last command. */
import { CloseButton } from '@mantine/core'
import { IconHandStop } from '@tabler/icons-react'
import { clearRefusal, useRefusal } from '../../api/refusal'
import { Notice } from '../../components/Notice'

export function RefusalLine() {
  const refusal = useRefusal((s) => s.refusal)
  if (!refusal) return null
  return (
    <Notice
      role="alert"
      icon={<IconHandStop size={17} aria-hidden />}
      tools={<CloseButton size="sm" aria-label="Put the refusal away" onClick={clearRefusal} />}
    >
      <strong>{refusal.what} was refused:</strong> {refusal.message}
      {refusal.hint && ` – ${refusal.hint}`}
    </Notice>
  )
}
