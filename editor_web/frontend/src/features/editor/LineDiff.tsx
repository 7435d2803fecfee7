/** Two texts side by side, with runs of equal lines folded. */
import { useMemo } from 'react'
import { folded, sideBySide } from '../../document/editing/textChange'

export function LineDiff({ label, left, right }: { readonly label: string; readonly left: string; readonly right: string }) {
  const lines = useMemo(() => folded(sideBySide(left, right)), [left, right])
  return (
    <div className="diff" role="region" tabIndex={0} aria-label={label}>
      {left === right && <div className="diff-fold">The two are the same.</div>}
      {lines.map((line, index) =>
        line === undefined ? (
          <div key={index} className="diff-fold">
            …
          </div>
        ) : (
          <div key={index} className={`diff-line${line.isSame ? '' : ' is-changed'}`}>
            <code className={line.left === undefined ? 'is-missing' : ''}>{line.left ?? ''}</code>
            <code className={line.right === undefined ? 'is-missing' : ''}>{line.right ?? ''}</code>
          </div>
        ),
      )}
    </div>
  )
}
