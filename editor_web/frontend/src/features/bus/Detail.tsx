/** The frame of what is shown of one entry: its name, what it is for, and the way back where there is little room. */
import { IconArrowLeft } from '@tabler/icons-react'
import type { ReactNode } from 'react'

interface DetailProps {
  readonly name: string
  readonly type: string
  readonly doc: string
  readonly onBack: () => void
  readonly children: ReactNode
}

export function Detail({ name, type, doc, onBack, children }: DetailProps) {
  return (
    <section className="bus-entry" aria-label={name}>
      <header className="bus-entry-head">
        <button type="button" className="bus-back" aria-label="Back to the list" onClick={onBack}>
          <IconArrowLeft size={15} aria-hidden />
        </button>
        <h3 className="mono">{name}</h3>
        <span className="quiet">{type}</span>
      </header>
      {doc && <p className="bus-doc">{inCode(doc)}</p>}
      {children}
    </section>
  )
}

/** Names between backticks as code. */
function inCode(doc: string): ReactNode {
  return doc.split('`').map((part, index) => (index % 2 === 1 ? <code key={index}>{part}</code> : part))
}

/** Why something cannot be sent, or what it may do. */
export function Caution({ mayChange, words }: { mayChange: boolean; words: string }) {
  if (!mayChange) return <p className="quiet">You may look only: log in with the operator token to send anything.</p>
  return <p className="bus-caution">{words}</p>
}
