/** Why the server, or the page itself, refused the last command. */
import { clearRefusal, useRefusal } from '../../api/refusal'
import { Refusal } from '../../components/Refusal'

export function RefusalLine() {
  const refusal = useRefusal((s) => s.refusal)
  if (!refusal) return null
  return (
    <Refusal isWide title={`${refusal.what} was refused:`} hint={refusal.hint} onClose={clearRefusal}>
      {refusal.message}
    </Refusal>
  )
}
