/** A page, in the list at the side that leads to all of them. */
import { NavLink, type NavLinkProps } from '@mantine/core'
import type { MouseEvent, ReactNode } from 'react'

export interface SideLinkProps {
  readonly href: string
  readonly onOpen: () => void
  /** Does the page show it, or something of it? */
  readonly isCurrent: boolean
  readonly label: ReactNode
  readonly description?: ReactNode
  readonly icon?: ReactNode
  readonly title?: string | undefined
}

/** How whatever stands in that list looks. */
export const SIDE_ITEM = {
  px: '2xs',
  py: 5,
  bdrs: 'md',
  styles: {
    root: { '--nl-bg': 'var(--accent-soft)', '--nl-hover': 'var(--accent-soft)', '--nl-color': 'var(--text)' },
    section: { marginInlineEnd: 8 },
    label: { fontWeight: 550 },
    description: { '--description-opacity': 1, '--description-color': 'var(--quiet)' },
  },
} satisfies NavLinkProps

export function SideLink({ href, onOpen, isCurrent, label, description, icon, title }: SideLinkProps) {
  return (
    <NavLink
      {...SIDE_ITEM}
      href={href}
      title={title}
      active={isCurrent}
      aria-current={isCurrent ? 'page' : undefined}
      leftSection={icon}
      label={label}
      description={description}
      onClick={(event: MouseEvent) => {
        if (event.metaKey || event.ctrlKey || event.shiftKey || event.button !== 0) return
        event.preventDefault()
        onOpen()
      }}
    />
  )
}
