/** Two texts side by side, with runs of equal lines folded. */
import { useMemo } from 'react'
import { folded, sideBySide } from '../../document/editing/textChange'
import classes from './versions.module.css'

export function LineDiff({ label, left, right }: { readonly label: string; readonly left: string; readonly right: string }) {
  const lines = useMemo(() => folded(sideBySide(left, right)), [left, right])
  return (
    <div className={classes['framed']} style={{ maxHeight: '52dvh' }} role="region" tabIndex={0} aria-label={label}>
      {left === right && <div className={classes['fold']}>The two are the same.</div>}
      {lines.map((line, index) =>
        line === undefined ? (
          <div key={index} className={classes['fold']}>
            …
          </div>
        ) : (
          <div key={index} className={classes['line']} data-changed={!line.isSame || undefined}>
            <code data-missing={line.left === undefined || undefined}>{line.left ?? ''}</code>
            <code data-missing={line.right === undefined || undefined}>{line.right ?? ''}</code>
          </div>
        ),
      )}
    </div>
  )
}
