/** A part of the form, with its title, that can be closed. */
import { IconChevronDown, IconChevronRight } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'

export interface SectionProps {
  readonly title: string
  readonly children: ReactNode
  readonly isClosed?: boolean
  /** Small words beside the title. */
  readonly note?: string | undefined
}

export function Section({ title, children, isClosed = false, note }: SectionProps) {
  const [isOpen, setOpen] = useState(!isClosed)
  const Chevron = isOpen ? IconChevronDown : IconChevronRight
  return (
    <section className="form-section" aria-label={title}>
      <h3>
        <button type="button" aria-expanded={isOpen} onClick={() => setOpen(!isOpen)}>
          <Chevron size={14} aria-hidden />
          {title}
          {note && <span className="form-note">{note}</span>}
        </button>
      </h3>
      {isOpen && <div className="form-body">{children}</div>}
    </section>
  )
}
