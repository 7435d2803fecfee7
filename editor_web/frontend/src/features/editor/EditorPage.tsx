/** The editor of one behavior: library, canvas, text, and the form of what is chosen. */
import { lookup } from '../../document/dict'
import { isError, problemsOf, unfinishedWords } from '../../document/editing/findings'
import { isGone } from '../../document/live'
import { Flex, Loader, Stack, Tabs } from '@mantine/core'
import { ReactFlowProvider, useReactFlow } from '@xyflow/react'
import { useEffect, useRef, useState, type ReactNode } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { offerCommands } from '../../api/search'
import { useLive } from '../../api/live'
import { askStartHere, type StartHere } from '../../api/startHere'
import { Empty } from '../../components/Empty'
import { WhileLoading, lazyView } from '../../components/lazyView'
import { Loading } from '../../components/Loading'
import { NoticePlace } from '../../components/NoticePlace'
import { Splitter } from '../../components/Splitter'
import { ViewBoundary } from '../../components/ViewBoundary'
import { lookForFindings } from './apply'
import { Canvas } from './Canvas'
import { CanvasBar } from './CanvasBar'
import { setPageActions } from './pageActions'
import { ConflictDialog } from './ConflictDialog'
import { ConflictPanel } from './ConflictPanel'
import { forgetDataFlow, useDataFlow } from './dataFlow'
import { DataFlowPanel } from './DataFlowPanel'
import { EditorArea } from './EditorArea'
import { EditorHead } from './EditorHead'
import { FileDialogs } from './FileDialogs'
import { useFileDialog } from './fileDialogs'
import { Inspector } from './Inspector'
import { storeDraftNow } from './draftStorage'
import { LibraryPanel } from './LibraryPanel'
import { DoneNote, NoticeLine } from './NoticeLine'
import { trackViewportMotion } from './viewportMotion'
import { Palettes } from './Palettes'
import { ReplaceDialog } from './ReplaceDialog'
import { SourceDialog } from './SourceDialog'
import { refreshReferences } from './references'
import { lookAtDisk, openDocument, save, takeStates } from './session'
import { CellViewContext } from './ShowEntry'
import { draftOf, editor, isDirty, showEditorRefusal, setEditor, useEditor } from './store'
import { searchCommands } from './searchCommands'
import { useLongPress } from './useLongPress'
import { useEditorKeys } from './useEditorKeys'
import { wholeCanvas } from './viewport'

const VersionsDialog = lazyView(async () => (await import('./VersionsDialog')).VersionsDialog)
const YamlPane = lazyView(async () => (await import('./YamlPane')).YamlPane)

export interface EditorPageProps {
  readonly id: string
  /** May this person save? */
  readonly mayEdit: boolean
  readonly isNarrow: boolean
  /** Go to the page where it is run. */
  readonly onRun: () => void
  /** Open another behavior, at a node where one is given. */
  readonly onOpen: (id: string, node: string) => void
  /** What else a behavior can be begun from. */
  readonly libraryTools?: ReactNode
  readonly hasCellView: boolean
  /** Named entries as they are seen in 3D, over the canvas. */
  readonly preview: ReactNode
  /** The behavior was deleted. */
  readonly onGone: () => void
}

export function EditorPage(props: EditorPageProps) {
  const { id } = props
  const phase = useEditor((s) => (s.id === id ? s.phase : 'loading'))
  const problem = useEditor((s) => s.problem)
  const onDisk = useLive((s) => lookup(s.documents, id))
  const written = useLive((s) => s.documents)
  useEffect(() => {
    forgetDataFlow()
    void openDocument(id, location.hash.slice(1))
  }, [id])
  useEffect(() => {
    if (onDisk && onDisk !== editor().base.hash) void lookAtDisk()
  }, [onDisk])
  useEffect(() => refreshReferences(written), [written])
  const statesRevision = useLive((s) => s.statesRevision)
  useEffect(() => {
    if (statesRevision > 0 && editor().phase === 'ready') void takeStates()
  }, [statesRevision])
  useUnsavedGuard()
  if (phase === 'failed') return <Empty title="This behavior cannot be edited">{problem}</Empty>
  if (phase === 'loading') return <Loader size="sm" m="auto" role="status" aria-label="Loading" />
  return (
    <ReactFlowProvider>
      <CellViewContext value={props.hasCellView}>
        <Loaded {...props} />
      </CellViewContext>
    </ReactFlowProvider>
  )
}

/** What is not saved is kept in this browser, and the browser warns before the page goes. */
function useUnsavedGuard(): void {
  useEffect(() => {
    const warn = (event: BeforeUnloadEvent) => {
      storeDraftNow()
      if (isDirty(editor()) || editor().unwritten.length > 0) event.preventDefault()
    }
    const look = () => document.visibilityState === 'visible' && !isGone(useLive.getState(), editor().id) && void lookAtDisk()
    addEventListener('beforeunload', warn)
    addEventListener('focus', look)
    document.addEventListener('visibilitychange', look)
    return () => {
      storeDraftNow()
      removeEventListener('beforeunload', warn)
      removeEventListener('focus', look)
      document.removeEventListener('visibilitychange', look)
    }
  }, [])
}

function Loaded({ mayEdit, isNarrow, onRun, onOpen, onGone, libraryTools, preview }: EditorPageProps) {
  useEffect(() => offerCommands(searchCommands), [])
  const isTextShown = useEditor((s) => s.isTextShown)
  const hasVersions = useFileDialog((s) => s.open === 'versions')
  const hasFlow = useDataFlow((s) => s.isShown)
  const [hasMap, setMap] = useState(false)
  const [boxSelects, setBoxSelects] = useState(false)
  const { setViewport, zoomTo, getZoom } = useReactFlow()
  const element = useRef<HTMLDivElement>(null)

  async function run(here?: Pick<StartHere, 'path' | 'kind'>): Promise<void> {
    ;(document.activeElement as HTMLElement | null)?.blur()
    await lookForFindings()
    const draft = draftOf(editor())
    if (draft.findings.some(isError)) {
      const errors = problemsOf(draft).filter(isError).length
      setEditor({ tab: 'problems' })
      if (errors === 0) showEditorRefusal('Run', 'the behavior is not finished.', unfinishedWords(draft.root))
      else showEditorRefusal('Run', errors === 1 ? 'there is an error.' : `there are ${errors} errors.`, 'See the problems.')
      return
    }
    if (!(await save())) return
    if (here) askStartHere({ behavior: editor().id, ...here })
    onRun()
  }
  useEffect(() =>
    setPageActions({
      run: (here) => void run(here),
      fit: () => trackViewportMotion(setViewport(wholeCanvas(), { duration: 200 })),
      zoom: (factor) => trackViewportMotion(zoomTo(getZoom() * factor, { duration: 120 })),
      open: (id, node) => {
        storeDraftNow()
        onOpen(id, node)
      },
    }),
  )
  useEditorKeys(element)
  useLongPress(element)

  const flow = (
    <ViewBoundary name="Data flow">
      <DataFlowPanel />
    </ViewBoundary>
  )
  const library = (
    <ViewBoundary name="Library">
      <LibraryPanel tools={libraryTools} />
    </ViewBoundary>
  )
  const form = (
    <ViewBoundary name="Form">
      <Inspector />
    </ViewBoundary>
  )
  const canvas = (
    <Stack h="100%" mih={0} gap={0}>
      <CanvasBar hasMap={hasMap} onMap={() => setMap(!hasMap)} boxSelects={boxSelects} onBoxSelects={() => setBoxSelects(!boxSelects)} />
      <Flex direction="column" flex={1} mih={0} data-below>
        <ViewBoundary name="Canvas">
          <Canvas hasMap={hasMap} boxSelects={boxSelects} />
        </ViewBoundary>
        {hasFlow && isNarrow && flow}
      </Flex>
    </Stack>
  )
  const text = (
    <Loading name="Text">
      <YamlPane />
    </Loading>
  )
  return (
    <EditorArea area={element}>
      <EditorHead mayEdit={mayEdit} onRun={() => void run()} />
      <NoticePlace>
        <NoticeLine />
      </NoticePlace>
      <DoneNote />
      <ConflictPanel />
      {isNarrow ? (
        <Tabs defaultValue="canvas">
          <Tabs.List>
            <Tabs.Tab value="canvas">Canvas</Tabs.Tab>
            <Tabs.Tab value="library">Library</Tabs.Tab>
            <Tabs.Tab value="form">Form</Tabs.Tab>
            <Tabs.Tab value="text">Text</Tabs.Tab>
          </Tabs.List>
          <Tabs.Panel value="canvas">{canvas}</Tabs.Panel>
          <Tabs.Panel value="library">{library}</Tabs.Panel>
          <Tabs.Panel value="form">{form}</Tabs.Panel>
          <Tabs.Panel value="text">{text}</Tabs.Panel>
        </Tabs>
      ) : (
        <Group orientation="horizontal" style={{ flex: 1, minHeight: 0 }}>
          <Pane id="library" defaultSize="17%" minSize="12%" maxSize="34%">
            {hasFlow ? flow : library}
          </Pane>
          <Splitter label="Width of the library" />
          <Pane id="middle" defaultSize="57%" minSize="30%" style={{ position: 'relative' }}>
            <Group orientation="vertical">
              <Pane id="canvas" defaultSize={isTextShown ? '56%' : '100%'} minSize="20%">
                {canvas}
              </Pane>
              {isTextShown && (
                <>
                  <Splitter label="Height of the text" isFlat />
                  <Pane id="text" defaultSize="44%" minSize="15%">
                    {text}
                  </Pane>
                </>
              )}
            </Group>
            {preview}
          </Pane>
          <Splitter label="Width of the form" />
          <Pane id="inspector" defaultSize="26%" minSize="20%" maxSize="50%">
            {form}
          </Pane>
        </Group>
      )}
      {isNarrow && preview}
      <Palettes />
      <ReplaceDialog />
      <SourceDialog />
      <ConflictDialog />
      <FileDialogs onGone={onGone} />
      <WhileLoading value={null}>{hasVersions && <VersionsDialog />}</WhileLoading>
    </EditorArea>
  )
}
