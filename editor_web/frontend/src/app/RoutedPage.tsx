/** The page that an address means; each but the first is loaded when it is first opened. */

import { useLive } from '../api/live'
import { hasCellView } from '../api/session'
import type { RunView, SessionBody } from '../api/types'
import { WhileLoading, lazyView } from '../components/lazyView'
import { ViewBoundary } from '../components/ViewBoundary'
import { isActive } from '../document/runState'
import { FromDemonstration } from '../features/demonstration/FromDemonstration'
import { HomePage } from './HomePage'
import { behaviorHref, editHref, PAST_HREF, runHref, type Route } from './route'

/** Brings the canvas with it, which the first page does not need. */
const BehaviorPage = lazyView(async () => (await import('./BehaviorPage')).BehaviorPage)
const TeachPage = lazyView(async () => (await import('./TeachPage')).TeachPage)
const CellPage = lazyView(async () => (await import('./CellPage')).CellPage)
const PastPage = lazyView(async () => (await import('./PastPage')).PastPage)
const PastRunsPage = lazyView(async () => (await import('./PastRunsPage')).PastRunsPage)
const RunsPage = lazyView(async () => (await import('./RunsPage')).RunsPage)
const BesidePage = lazyView(async () => (await import('./SideBySidePage')).SideBySidePage)
const ComparePage = lazyView(async () => (await import('./ComparePage')).ComparePage)
const TrendPage = lazyView(async () => (await import('./TrendPage')).TrendPage)
const SweepsPage = lazyView(async () => (await import('./SweepsPage')).SweepsPage)
const SweepPage = lazyView(async () => (await import('./SweepPage')).SweepPage)
const EditorPage = lazyView(async () => (await import('../features/editor/EditorPage')).EditorPage)
const EditorWizard = lazyView(async () => (await import('./EditorWizard')).EditorWizard)
const EditorPreview = lazyView(async () => (await import('./EditorPreview')).EditorPreview)

export interface RoutedPageProps {
  readonly route: Route
  /** The run of the page, if any. */
  readonly shown: RunView | undefined
  readonly session: SessionBody | undefined
  readonly isNarrow: boolean
  readonly onOpen: (href: string) => void
}

export function RoutedPage(props: RoutedPageProps) {
  const { route, shown, session, isNarrow, onOpen } = props
  const active = useLive((s) => s.runs).filter(isActive)
  // A run that this server has not started may be in its journal.
  const knowsRuns = useLive((s) => s.knowsRuns)
  switch (route.page) {
    case 'edit':
      return <Edit {...props} id={route.id} />
    case 'teach':
      return <TeachPage session={session} isNarrow={isNarrow} />
    case 'cell':
      return (
        <>
          <CellPage item={route.item} session={session} isNarrow={isNarrow} onOpen={onOpen} />
          <WhileLoading value={null}>
            <EditorWizard hasView={hasCellView(session)} isNarrow={isNarrow} />
          </WhileLoading>
        </>
      )
    case 'past':
      return <PastRunsPage onOpen={onOpen} />
    case 'runs':
      return <RunsPage onOpen={onOpen} />
    case 'beside':
      return <BesidePage left={route.left} right={route.right} isNarrow={isNarrow} onOpen={onOpen} />
    case 'compare':
      return <ComparePage left={route.left} right={route.right} isNarrow={isNarrow} onOpen={onOpen} />
    case 'trend':
      return <TrendPage key={route.behavior} behavior={route.behavior} onOpen={onOpen} />
    case 'sweeps':
      return <SweepsPage onOpen={onOpen} />
    case 'sweep':
      return <SweepPage key={route.id} id={route.id} onOpen={onOpen} />
    case 'home':
      return <HomePage hasCellView={hasCellView(session)} onOpenRun={(id) => onOpen(runHref(id))} />
    default:
      break
  }
  if (route.page === 'recording' || (route.page === 'run' && knowsRuns && !shown)) {
    return (
      <PastPage
        key={route.id}
        id={route.id}
        isRecording={route.page === 'recording'}
        session={session}
        isNarrow={isNarrow}
        onAll={() => onOpen(PAST_HREF)}
        onOpen={onOpen}
      />
    )
  }
  const behavior = route.page === 'behavior' ? route.id : shown?.behavior
  if (!behavior) return <div role="status" aria-label="Loading" />
  return (
    <BehaviorPage
      key={behavior}
      id={behavior}
      run={shown}
      active={active}
      session={session}
      isNarrow={isNarrow}
      onStarted={() => onOpen(behaviorHref(behavior))}
      onEdit={(node) => onOpen(editHref(behavior, node))}
      onMade={(made) => onOpen(editHref(made))}
    />
  )
}

function Edit({ id, session, isNarrow, onOpen }: RoutedPageProps & { readonly id: string }) {
  const mayEdit = session?.role === 'operator'
  const preview = (
    <ViewBoundary name="Preview">
      <WhileLoading value={null}>
        <EditorPreview isNarrow={isNarrow} />
        <EditorWizard hasView={hasCellView(session)} isNarrow={isNarrow} />
      </WhileLoading>
    </ViewBoundary>
  )
  return (
    <EditorPage
      key={id}
      id={id}
      mayEdit={mayEdit}
      isNarrow={isNarrow}
      onRun={() => onOpen(behaviorHref(id))}
      onOpen={(other, node) => onOpen(editHref(other, node))}
      onGone={() => onOpen('/')}
      hasCellView={hasCellView(session)}
      preview={preview}
      libraryTools={mayEdit ? <FromDemonstration onMade={(made) => onOpen(editHref(made))} /> : undefined}
    />
  )
}
