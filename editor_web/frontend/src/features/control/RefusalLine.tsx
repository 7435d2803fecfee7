/** Why the server, or the page itself, refused the last command. */
import { CloseButton } from '@mantine/core'
import { IconHandStop } from '@tabler/icons-react'
import { clearRefusal, useRefusal } from '../../api/refusal'

export function RefusalLine() {
  const refusal = useRefusal((s) => s.refusal)
  if (!refusal) return null
  return (
    <div className="refusal" role="alert">
      <IconHandStop size={17} aria-hidden />
      <span>
        <strong>{refusal.what} was refused:</strong> {refusal.message}
        {refusal.hint && <span className="quiet"> – {refusal.hint}</span>}
      </span>
      <CloseButton size="sm" aria-label="Put the refusal away" onClick={clearRefusal} />
    </div>
  )
}
