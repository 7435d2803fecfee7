/** The failures that a search has found in large digits, and the success that is nearest to one. */
import type { SearchLive } from '../../api/types'
import { failuresText } from '../../document/searches'
import { short } from '../../document/sweeps'
import { BigFigure } from './BigFigure'

export function FailureCount({ search, towards }: { readonly search: SearchLive; readonly towards: string }) {
  return (
    <BigFigure figure={failuresText(search)}>
      {search.nearest !== null && (
        <span>
          nearest success: {towards} {short(search.nearest)}
        </span>
      )}
    </BigFigure>
  )
}
