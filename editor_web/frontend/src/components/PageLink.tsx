/** A link within the page: a plain click goes there without loading, any other one is the browser's. */
import { Anchor } from '@mantine/core'
import type { MouseEvent, ReactNode } from 'react'

interface PageLinkProps {
  readonly href: string
  readonly onOpen: () => void
  /** Of a link that does not look like one. */
  readonly className?: string | undefined
  readonly title?: string | undefined
  /** Its name, where its words are not always seen. */
  readonly label?: string | undefined
  /** Is it the page that is shown? */
  readonly isCurrent?: boolean
  readonly children: ReactNode
}

export function PageLink({ href, onOpen, className, title, label, isCurrent = false, children }: PageLinkProps) {
  const shared = {
    href,
    title,
    'aria-label': label,
    'aria-current': isCurrent ? ('page' as const) : undefined,
    onClick: (event: MouseEvent) => {
      if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
      event.preventDefault()
      onOpen()
    },
  }
  if (className === undefined) {
    return (
      <Anchor inherit {...shared}>
        {children}
      </Anchor>
    )
  }
  return (
    <a className={className} {...shared}>
      {children}
    </a>
  )
}
