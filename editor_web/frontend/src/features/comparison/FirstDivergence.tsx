/** Where two runs first differ, in words, and the jump there. */
import { Button } from '@mantine/core'
import { IconArrowDown, IconEqual, IconGitFork } from '@tabler/icons-react'
import type { Divergence } from '../../api/types'
import styles from './comparison.module.css'

interface FirstDivergenceProps {
  readonly divergence: Divergence | null
  readonly onShow: () => void
}

export function FirstDivergence({ divergence, onShow }: FirstDivergenceProps) {
  if (!divergence) {
    return (
      <div className={`${styles.divergence} ${styles.isNone}`} role="status">
        <IconEqual size={18} aria-hidden />
        <p>Both runs visited the same nodes, and each ended in the same way.</p>
      </div>
    )
  }
  const times = [
    divergence.left_s !== null && `left at ${divergence.left_s.toFixed(2)} s`,
    divergence.right_s !== null && `right at ${divergence.right_s.toFixed(2)} s`,
  ]
  return (
    <div className={styles.divergence} role="status">
      <IconGitFork size={18} aria-hidden />
      <p>
        <strong>First divergence:</strong> {divergence.text} <span className="quiet">({times.filter(Boolean).join(', ')})</span>
      </p>
      <Button variant="default" size="xs" leftSection={<IconArrowDown size={14} aria-hidden />} onClick={onShow}>
        Show
      </Button>
    </div>
  )
}
