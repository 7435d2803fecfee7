/** Two versions side by side: what differs in words, on both drawings, and in the text; one alone read-only. */
import { useEffect, useMemo, useState } from 'react'
import type { DocumentDiff } from '../../api/types'
import { containersOfMarks, markingsOf, meaningful, wordsOfChange, type Marking } from '../../document/editing/changes'
import type { EditNode } from '../../document/editing/model'
import { drawingOf, openWith, type Drawing } from './drawing'
import { LineDiff } from './LineDiff'
import { Picture } from './Picture'
import { OF_PAGE } from './pictureParts'

/** One version, or the draft. */
export interface Shown {
  readonly text: string
  /** Undefined where the text cannot be read. */
  readonly root: EditNode | undefined
  readonly outcomes: readonly string[]
  readonly words: string
}

export interface VersionViewProps {
  readonly before: Shown | undefined
  readonly after: Shown
  readonly difference: DocumentDiff | undefined
}

const VIEWS = ['Changes', 'This version', 'Text'] as const
type View = (typeof VIEWS)[number]

export function VersionView({ before, after, difference }: VersionViewProps) {
  const [view, setView] = useState<View>(before ? 'Changes' : 'This version')
  return (
    <>
      <div role="tablist" aria-label="What is shown" className="version-tabs">
        {VIEWS.map((each) => (
          <button
            key={each}
            type="button"
            role="tab"
            aria-selected={each === view}
            className={`command is-quiet${each === view ? ' is-chosen' : ''}`}
            onClick={() => setView(each)}
          >
            {each}
          </button>
        ))}
      </div>
      <div role="tabpanel" aria-label={view} className="version-panel">
        {view === 'Changes' && before && <Changes before={before} after={after} difference={difference} />}
        {view === 'Changes' && !before && <p className="quiet">This is the oldest version that is kept.</p>}
        {view === 'This version' && <Drawn of={after} markings={NO_MARKS} rowPx={ROW_PX} />}
        {view === 'Text' && <TextDifference before={before} after={after} />}
      </div>
    </>
  )
}

const ROW_PX = 1100
const HALF_ROW_PX = 640
const NO_MARKS: ReadonlyMap<string, Marking> = new Map()

function Changes({ before, after, difference }: { before: Shown; after: Shown; difference: DocumentDiff | undefined }) {
  const changes = useMemo(() => meaningful(difference?.changes ?? []), [difference])
  const marks = useMemo(() => markingsOf(changes, before.root, after.root), [changes, before, after])
  const words = changes.map(wordsOfChange)
  if (!difference) return <p className="quiet">One of the two cannot be read as a behavior; the tab Text shows how they differ.</p>
  if (changes.length === 0)
    return (
      <p className="quiet">
        {before.text === after.text ? 'The two are the same.' : 'They mean the same; only comments or layout differ.'}
      </p>
    )
  return (
    <div className="changes">
      <ul className="plain-list change-list" aria-label="What differs">
        {difference.layout_only && <li className="quiet">Only places on the canvas differ.</li>}
        {words.map((each, index) => (
          <li key={index} className={`change is-${each.kind}`}>
            <strong>{each.title}</strong>
            {each.lines.map((line, at) => (
              <span key={at} className="quiet">
                {line}
              </span>
            ))}
          </li>
        ))}
      </ul>
      <div className="two-drawings">
        <figure>
          <figcaption>{before.words}</figcaption>
          <Drawn of={before} markings={marks.before} rowPx={HALF_ROW_PX} />
        </figure>
        <figure>
          <figcaption>{after.words}</figcaption>
          <Drawn of={after} markings={marks.after} rowPx={HALF_ROW_PX} />
        </figure>
      </div>
      <p className="quiet change-key">
        <span className="is-added">+ added</span> <span className="is-removed">− removed</span>{' '}
        <span className="is-changed">≠ changed or moved</span>
      </p>
    </div>
  )
}

function Drawn({ of, markings, rowPx }: { of: Shown; markings: ReadonlyMap<string, Marking>; rowPx: number }) {
  const [drawing, setDrawing] = useState<Drawing>()
  const [problem, setProblem] = useState('')
  const { root, outcomes, words } = of
  useEffect(() => {
    if (!root) return
    let isCurrent = true
    // Beside one another there is little room: what is marked is shown, the rest stays closed.
    const needed = containersOfMarks(markings)
    const isOpen = rowPx < ROW_PX ? (path: string) => needed.has(path) : openWith(root)
    drawingOf(root, outcomes, isOpen, rowPx).then(
      (made) => isCurrent && setDrawing(made),
      (error: unknown) => isCurrent && setProblem(String(error)),
    )
    return () => {
      isCurrent = false
    }
  }, [root, outcomes, markings, rowPx])
  if (!root || problem) return <p className="quiet">{problem || 'This text cannot be read as a behavior.'}</p>
  return (
    <div className="drawing" role="region" tabIndex={0} aria-label={`Drawing of the version ${words}`}>
      {drawing && <Picture drawn={drawing} title={words} palette={OF_PAGE} markings={markings} />}
    </div>
  )
}

function TextDifference({ before, after }: { before: Shown | undefined; after: Shown }) {
  if (!before) return <pre className="version-text">{after.text}</pre>
  return (
    <>
      <div className="conflict-heads">
        <strong>{before.words}</strong>
        <strong>{after.words}</strong>
      </div>
      <LineDiff label="Differences, the older one on the left" left={before.text} right={after.text} />
    </>
  )
}
