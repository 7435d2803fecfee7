/** What the editor has to say: a refusal with its advice, a draft taken up again, a file that changed. */
import { Box, CloseButton, Flex, Paper } from '@mantine/core'
import { IconAlertTriangle, IconCheck, IconHistory } from '@tabler/icons-react'
import { useEffect, type ReactNode } from 'react'
import { useLive } from '../../api/live'
import { Refusal } from '../../components/Refusal'
import { isGone } from '../../document/live'
import { LinkButton } from './FormParts'
import classes from './frame.module.css'
import { discard, save, writeAgain } from './session'
import { editor, setEditor, useEditor } from './store'

const SHORT_MS = 2500
const TOAST = { zIndex: 20, transform: 'translateX(-50%)', pointerEvents: 'none' } as const

export function NoticeLine() {
  const notice = useEditor((s) => s.notice)
  const isRestored = useEditor((s) => s.isRestored)
  const id = useEditor((s) => s.id)
  const gone = useLive((s) => isGone(s, id))
  const isOutdated = useEditor((s) => s.isOutdated && !gone)
  return (
    <>
      {gone && (
        <Note tone="warning" icon={<IconAlertTriangle size={16} aria-hidden />}>
          <span>The file has been deleted. What you see is kept in this browser.</span>
          <LinkButton onPress={() => void writeAgain()}>Save it again</LinkButton>
        </Note>
      )}
      {isOutdated && (
        <Note tone="warning" icon={<IconAlertTriangle size={16} aria-hidden />}>
          <span>The file has changed on disk since you began. Saving merges both by nodes.</span>
          <LinkButton onPress={() => void save()}>Merge now</LinkButton>
          <LinkButton onPress={() => void discard()}>Take the file</LinkButton>
        </Note>
      )}
      {isRestored && !isOutdated && (
        <Note tone="plain" icon={<IconHistory size={16} aria-hidden />}>
          <span>Your unsaved changes of an earlier visit are here.</span>
          <LinkButton onPress={() => void discard()}>Discard them</LinkButton>
          <CloseButton size="sm" aria-label="Close the note about unsaved changes" onClick={() => setEditor({ isRestored: false })} />
        </Note>
      )}
      {notice?.tone === 'refused' && (
        <div data-notice="refused">
          <Refusal isWide title={`${notice.what}:`} hint={notice.hint} onClose={() => setEditor({ notice: undefined })}>
            {notice.message}
          </Refusal>
        </div>
      )}
    </>
  )
}

/** What was done, for a moment at the foot of the page. */
export function DoneNote() {
  const notice = useEditor((s) => s.notice)
  useEffect(() => {
    if (notice?.tone !== 'done') return
    const timer = setTimeout(() => editor().notice === notice && setEditor({ notice: undefined }), SHORT_MS)
    return () => clearTimeout(timer)
  }, [notice])
  return (
    <Box pos="absolute" bottom={20} left="50%" style={TOAST} role="status">
      {notice?.tone === 'done' && (
        <Paper shadow="md" px="md" py={6} bg="var(--text)" c="var(--surface)" radius="xl">
          <Flex align="center" gap={6} fz="sm" fw={550}>
            <IconCheck size={15} aria-hidden /> {notice.message}
          </Flex>
        </Paper>
      )}
    </Box>
  )
}

const GROUNDS = { plain: 'var(--accent-soft)', warning: 'var(--stopped-soft)' }

interface NoteProps {
  readonly tone: keyof typeof GROUNDS
  readonly icon: ReactNode
  readonly children: ReactNode
}

function Note({ tone, icon, children }: NoteProps) {
  return (
    <Flex
      align="center"
      gap="xs"
      px="md"
      py={6}
      fz="sm"
      bg={GROUNDS[tone]}
      className={classes['note']}
      role={tone === 'plain' ? 'status' : 'alert'}
      data-notice={tone}
    >
      {icon}
      {children}
    </Flex>
  )
}
