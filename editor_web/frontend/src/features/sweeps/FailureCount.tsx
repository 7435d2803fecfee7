/** The failures that a search has found in large digits, and the success that is nearest to one. */
import type { SearchLive } from '../../api/types'
import { failuresText } from '../../document/searches'
import { short } from '../../document/sweeps'

export function FailureCount({ search, towards }: { readonly search: SearchLive; readonly towards: string }) {
  return (
    <p className="sweep-success">
      <strong>{failuresText(search)}</strong>
      {search.nearest !== null && (
        <span>
          nearest success: {towards} {short(search.nearest)}
        </span>
      )}
    </p>
  )
}
