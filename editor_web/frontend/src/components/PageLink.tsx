/** A link within the page: a plain click goes there without loading, any other one is the browser's. */
import type { ReactNode } from 'react'

interface PageLinkProps {
  readonly href: string
  readonly onOpen: () => void
  readonly className?: string
  readonly title?: string
  /** Is it the page that is shown? */
  readonly isCurrent?: boolean
  readonly children: ReactNode
}

export function PageLink({ href, onOpen, className = 'link', title, isCurrent = false, children }: PageLinkProps) {
  return (
    <a
      href={href}
      className={className}
      title={title}
      aria-current={isCurrent ? 'page' : undefined}
      onClick={(event) => {
        if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
        event.preventDefault()
        onOpen()
      }}
    >
      {children}
    </a>
  )
}
