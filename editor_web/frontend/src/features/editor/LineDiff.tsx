/** Two texts side by side, with runs of equal lines folded. */
import { Box } from '@mantine/core'
import { useMemo } from 'react'
import { folded, sideBySide } from '../../document/editing/textChange'
import classes from './versions.module.css'

export function LineDiff({ label, left, right }: { readonly label: string; readonly left: string; readonly right: string }) {
  const lines = useMemo(() => folded(sideBySide(left, right)), [left, right])
  return (
    <div className={classes['framed']} style={{ maxHeight: '52dvh' }} role="region" tabIndex={0} aria-label={label}>
      {left === right && <Fold>The two are the same.</Fold>}
      {lines.map((line, index) =>
        line === undefined ? (
          <Fold key={index}>…</Fold>
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

function Fold({ children }: { readonly children: string }) {
  return (
    <Box px={10} py={2} bg="var(--ground)" c="dimmed">
      {children}
    </Box>
  )
}
