/** A named entry as an arm would be there, in 3D and in numbers; it is seen by this page only, until it is closed. */
import { lookup } from '../../document/dict'
import { Box, CloseButton, Flex, NativeSelect, Text, Title, VisuallyHidden } from '@mantine/core'
import { useEffect, useInsertionEffect, useRef, useState, type KeyboardEvent, type ReactNode } from 'react'
import type { Previewed } from '../../api/preview'
import { connectTeach, previewTaught, endPreview, useTeach } from '../../api/teaching'
import type { ArmInfo } from '../../api/types'
import { useModal } from '../../components/modal'
import { PLACED } from '../../document/editing/preview'
import { EntryFacts } from './EntryFacts'
import classes from './EntryPreview.module.css'
import { useEntryTrace } from './useEntryTrace'

export interface EntryPreviewProps {
  readonly shown: Previewed
  /** The 3D view of this page. */
  readonly view: ReactNode
  readonly tools: ReactNode
  /** It comes up from below, over everything else. */
  readonly isSheet: boolean
  readonly onClose: () => void
}

const LINE = '1px solid var(--line)'

export function EntryPreview({ shown, view, tools, isSheet, onClose }: EntryPreviewProps) {
  useEffect(connectTeach, [])
  const arms = useTeach((s) => s.arms)
  const isOpen = useTeach((s) => s.isOpen)
  const { arm, choose } = useArm(shown, arms)
  const isHere = arms?.some((each) => each.name === arm) ?? false
  const course = useEntryTrace(shown.kind, shown.name, isHere ? arm : '')
  useGhost(shown, isOpen && isHere ? arm : '')
  const close = useReturn(shown.by, onClose)
  const message = obstacle(shown, arms, arm, isOpen) || course.problem || course.trace?.remark || ''
  const title = shown.name || 'No entry'
  const body = (
    <>
      <Flex component="header" flex="none" align="center" gap="xs" mih="2.5rem" pl="sm" pr="xs" py={4} style={{ borderBottom: LINE }}>
        <Title order={2} size="sm" mr="auto" lineClamp={1}>
          {title}{' '}
          <Text span inherit ml={6} fw={450} c="dimmed">
            {lookup(PLACED, shown.kind)}
          </Text>
        </Title>
        {arms && arms.length > 0 && <ArmChoice arms={arms} arm={arm} isLarge={isSheet} onChoose={choose} />}
        {tools}
        <CloseButton size="sm" aria-label="Close the preview" onClick={close} />
      </Flex>
      <Box flex={1} mih="7.5rem">
        {view}
      </Box>
      <Box flex="none" mah="40%" px="sm" py="xs" style={{ overflowY: 'auto', borderTop: LINE }}>
        <Text role="status" size="xs" mb={message ? 4 : 0} c="var(--failed)">
          {message || <VisuallyHidden>{course.trace && `${arm} is shown at ${shown.name}`}</VisuallyHidden>}
        </Text>
        <EntryFacts course={course} />
      </Box>
    </>
  )
  if (isSheet)
    return (
      <Sheet label={`Preview of ${title}`} onClose={close}>
        {body}
      </Sheet>
    )
  const onKeyDown = (event: KeyboardEvent) => {
    // A menu that is open over it closes first.
    if (event.key !== 'Escape' || event.defaultPrevented) return
    event.stopPropagation()
    close()
  }
  return (
    // oxlint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- a key of what is in it
    <section className={classes.preview} aria-label={`Preview of ${title}`} onKeyDown={onKeyDown}>
      {body}
    </section>
  )
}

function obstacle(shown: Previewed, arms: readonly ArmInfo[] | undefined, arm: string, isOpen: boolean): string {
  if (arms === undefined) return ''
  if (!isOpen) return 'The server does not answer; nothing is shown until it does.'
  if (arms.length === 0) return 'This cell has no arm that could be shown.'
  if (!shown.name) return 'No entry is selected.'
  return arms.some((each) => each.name === arm) ? '' : `This cell has no arm ${arm}; choose another one.`
}

/** The arm that the entry is meant for, or the first one, until somebody chooses another. */
function useArm({ by, arm: meant }: Previewed, arms: readonly ArmInfo[] | undefined) {
  const [chosen, setChosen] = useState({ of: '', arm: '' })
  // The library says of no entry for which arm it is: the choice stays from one to the next.
  const of = meant ? `${by} ${meant}` : ''
  const arm = (chosen.of === of && chosen.arm) || meant || (arms?.[0]?.name ?? '')
  return { arm, choose: (next: string) => setChosen({ of, arm: next }) }
}

function useGhost({ kind, name }: Previewed, arm: string): void {
  const changed = useTeach((s) => s.entries)
  useEffect(() => {
    if (!arm || !name) return
    previewTaught(arm, { kind, name, capture: 0 })
    return endPreview
  }, [kind, name, arm, changed])
}

/** Closing goes back to what opened it. */
function useReturn(by: string, onClose: () => void): () => void {
  const opener = useRef<Element>(null)
  // Before a sheet takes the keyboard, in a layout effect of its own, which comes before those around it.
  useInsertionEffect(() => {
    opener.current = document.activeElement
  }, [by])
  return () => {
    onClose()
    if (opener.current instanceof HTMLElement && opener.current.isConnected) opener.current.focus()
  }
}

interface ArmChoiceProps {
  readonly arms: readonly ArmInfo[]
  readonly arm: string
  /** For fingers. */
  readonly isLarge: boolean
  readonly onChoose: (arm: string) => void
}

function ArmChoice({ arms, arm, isLarge, onChoose }: ArmChoiceProps) {
  const isHere = arms.some((each) => each.name === arm)
  if (arms.length === 1 && isHere)
    return (
      <Text span size="xs" c="dimmed">
        {arm}
      </Text>
    )
  return (
    <NativeSelect
      size={isLarge ? 'sm' : 'xs'}
      aria-label="Arm that is shown"
      value={isHere ? arm : ''}
      data={[...(isHere ? [] : [{ value: '', label: 'Choose an arm' }]), ...arms.map((each) => each.name)]}
      onChange={(event) => onChoose(event.currentTarget.value)}
    />
  )
}

/** The browser's own dialog: it keeps the keyboard inside, and closes with Escape. */
function Sheet({ label, onClose, children }: { readonly label: string; readonly onClose: () => void; readonly children: ReactNode }) {
  const element = useRef<HTMLDialogElement>(null)
  useModal(element)
  return (
    // oxlint-disable-next-line jsx-a11y/click-events-have-key-events, jsx-a11y/no-noninteractive-element-interactions -- Escape closes it too
    <dialog
      ref={element}
      className={classes.preview}
      aria-label={label}
      onClose={onClose}
      onClick={(event) => event.target === element.current && onClose()}
    >
      {children}
    </dialog>
  )
}
