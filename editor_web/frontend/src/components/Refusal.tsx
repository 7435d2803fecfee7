/** Why something was not done, and what can be done about it: the one look of it, in a dialog, a panel, or across the page. */
import { CloseButton } from '@mantine/core'
import { IconHandStop } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import { Notice } from './Notice'

export interface RefusalProps {
  /** The reason; nothing is drawn without one. */
  readonly children: ReactNode
  /** What was not done, as a sentence or with a colon. */
  readonly title?: string
  readonly hint?: string
  /** Across the page, instead of inside of what was asked for. */
  readonly isWide?: boolean
  readonly onClose?: () => void
}

export function Refusal({ children, title, hint, isWide = false, onClose }: RefusalProps) {
  if (!children) return null
  return (
    <Notice
      role="alert"
      isInset={!isWide}
      icon={<IconHandStop size={17} aria-hidden />}
      tools={onClose && <CloseButton size="sm" aria-label="Put the refusal away" onClick={onClose} />}
    >
      {title && <strong>{title} </strong>}
      {children}
      {hint && ` – ${hint}`}
    </Notice>
  )
}
