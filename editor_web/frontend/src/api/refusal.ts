/** Commands to the server, and what it said when it refused the last one. */
import { ServerError } from './client'
import { pageStore } from './pageStore'

export interface Refusal {
  /** The command in words, `Pause`. */
  readonly what: string
  readonly message: string
  readonly hint: string
}

export const useRefusal = pageStore<{ readonly refusal: Refusal | undefined }>(() => ({ refusal: undefined }))

/** Say why a command was not even sent. */
export function showRefusal(what: string, message: string, hint = ''): void {
  useRefusal.setState({ refusal: { what, message, hint } })
}

/** Take the words away. */
export function clearRefusal(): void {
  useRefusal.setState({ refusal: undefined })
}

/** Send a command; its answer, or undefined with the refusal kept for all to see. */
export async function send<T>(what: string, request: () => Promise<T>): Promise<T | undefined> {
  const before = useRefusal.getState().refusal
  try {
    const answer = await request()
    // Another command may have been refused meanwhile; those words stay.
    if (useRefusal.getState().refusal === before) clearRefusal()
    return answer
  } catch (error) {
    if (error instanceof ServerError) showRefusal(what, error.body.message, error.body.hint)
    else showRefusal(what, error instanceof Error ? error.message : String(error))
    return undefined
  }
}
